#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Data flows one way through host/: each folder may include only itself, the folders above it in ORDER and
# kernels/shared; and each device or file library is known to few files only. The rules are tried on planted
# violations first, then applied to the source.
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The folders of host/ in include order.
ORDER = ["base", "scene", "sampling", "bvh", "device", "film", "wavefront", "reference", "cli"]

# Prefix of a library's headers -> the only places of host/ that may include them: folders or files.
CONFINED = {
    "embree3/": ["bvh", "reference"],
    "OpenEXR/": ["film"],
    "Imf": ["film"],
    "CL/": ["device/opencl.h"],
    "tiny_gltf.h": ["scene"],
    "stb_image": ["scene"],
    "png.h": ["film"],
    "CLI/": ["cli"],
    "spdlog/": ["base/log.cpp"],
}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def host_violations(path, text):
    """The broken rules of a file of host/, as sentences. path is relative to host/, with forward slashes."""
    folder = path.split("/")[0]
    found = []
    if folder not in ORDER:
        return [f"host/{path}: folder '{folder}' has no place in the include order"]
    allowed = ORDER[: ORDER.index(folder) + 1]
    for bracket, header in INCLUDE.findall(text):
        for prefix, places in CONFINED.items():
            if header.startswith(prefix) and not any(path == p or folder == p for p in places):
                found.append(f"host/{path}: includes {header}, which belongs to {' and '.join(places)}")
        if bracket == "<":
            continue
        target = header.split("/")[0]
        if target == "shared":
            continue
        if "/" not in header or target not in ORDER:
            found.append(f'host/{path}: "{header}" must be named from host/ or from kernels/ (shared/...)')
        elif target not in allowed:
            found.append(f"host/{path}: {folder} may not include {target}, which comes after it")
    return found


def shared_violations(path, text):
    """The same for a file of kernels/shared, which C++ and OpenCL C both include."""
    found = []
    for bracket, header in INCLUDE.findall(text):
        if bracket == '"' and not header.startswith("shared/"):
            found.append(f'kernels/shared/{path}: may include only "shared/...", not "{header}"')
        if bracket == "<" and not re.fullmatch(r"c[a-z]+|bit|limits|type_traits", header):
            found.append(f"kernels/shared/{path}: may include no library, not <{header}>")
    return found


def kernel_violations(path, text):
    """A kernel includes shared/ and lib/; a lib file too; nothing else."""
    return [
        f'kernels/{path}: may include only "shared/..." and "lib/...", not {header}'
        for bracket, header in INCLUDE.findall(text)
        if bracket == "<" or header.split("/")[0] not in ("shared", "lib")
    ]


class PlantedViolations(unittest.TestCase):
    """Each rule must catch what it forbids and let pass what it allows."""

    def assert_violations(self, count, found):
        self.assertEqual(count, len(found), found)

    def test_lower_folder_gives_violation(self):
        self.assert_violations(1, host_violations("scene/gltf.cpp", '#include "film/image.h"\n'))
        self.assert_violations(1, host_violations("base/log.h", '#include "scene/scene.h"\n'))

    def test_upper_and_own_folder_pass(self):
        text = '#include "base/error.h"\n#include "scene/scene.h"\n#include "shared/bvh.h"\n#include <vector>\n'
        self.assert_violations(0, host_violations("scene/gltf.cpp", text))
        self.assert_violations(0, host_violations("cli/main.cpp", text))

    def test_relative_and_unknown_names_give_violation(self):
        self.assert_violations(1, host_violations("scene/gltf.cpp", '#include "scene.h"\n'))
        self.assert_violations(1, host_violations("scene/gltf.cpp", '#include "../base/error.h"\n'))
        self.assert_violations(1, host_violations("extra/new.cpp", ""))

    def test_confined_library_gives_violation_elsewhere(self):
        self.assert_violations(1, host_violations("wavefront/scheduler.cpp", "#include <embree3/rtcore.h>\n"))
        self.assert_violations(1, host_violations("cli/render.cpp", "  #  include <OpenEXR/ImfHeader.h>\n"))
        self.assert_violations(1, host_violations("device/buffer.cpp", "#include <CL/opencl.hpp>\n"))
        self.assert_violations(0, host_violations("device/opencl.h", "#include <CL/opencl.hpp>\n"))
        self.assert_violations(0, host_violations("bvh/builder.cpp", "#include <embree3/rtcore.h>\n"))
        self.assert_violations(0, host_violations("film/exr.cpp", "#include <OpenEXR/ImfHeader.h>\n"))

    def test_commented_include_passes(self):
        self.assert_violations(0, host_violations("base/log.h", '// #include "cli/main.h"\n'))

    def test_shared_header_with_host_include_gives_violation(self):
        self.assert_violations(1, shared_violations("types.h", '#include "base/math.h"\n'))
        self.assert_violations(1, shared_violations("types.h", "#include <Imath/ImathVec.h>\n"))
        self.assert_violations(0, shared_violations("bvh.h", '#include "shared/types.h"\n#include <cstdint>\n'))

    def test_kernel_with_host_include_gives_violation(self):
        self.assert_violations(1, kernel_violations("trace.cl", '#include "base/math.h"\n'))
        self.assert_violations(0, kernel_violations("trace.cl", '#include "lib/sampler.clh"\n'))


class Source(unittest.TestCase):
    def check(self, folder, patterns, rule):
        found, files = [], 0
        for pattern in patterns:
            for file in sorted((ROOT / folder).rglob(pattern)):
                files += 1
                found += rule(file.relative_to(ROOT / folder).as_posix(), file.read_text(encoding="utf-8"))
        self.assertGreater(files, 0, f"no sources in {folder}")
        self.assertEqual([], found, "\n".join(found))

    def test_host_includes_only_upwards(self):
        self.check("host", ["*.h", "*.cpp"], host_violations)

    def test_shared_headers_stand_alone(self):
        self.check("kernels/shared", ["*.h"], shared_violations)

    def test_kernels_include_only_kernels(self):
        self.check("kernels", ["*.cl", "*.clh"], kernel_violations)


if __name__ == "__main__":
    unittest.main()
