// SPDX-License-Identifier: Apache-2.0
// The text of kernels: embedded in the program at build time, or read from the folder OBSCURA_KERNEL_DIR.
// Includes are expanded on the host, because an OpenCL compiler has no access to embedded files.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace obscura {

struct EmbeddedFile {
    std::string_view path;  // relative to kernels/: "trace.cl", "shared/bvh.h"
    std::string_view text;
};

// Every file of kernels/, sorted by path. Defined in a source file that the build generates.
std::span<const EmbeddedFile> embedded_kernel_files();

// The text of a file of kernels/. Throws InputError if there is none.
std::string kernel_text(std::string_view path);

// The file with each #include "..." replaced by that file's text, once each, and #line directives so that
// diagnostics name real files and lines. A missing include is an InputError with file and line.
std::string expand_kernel_file(std::string_view path);
// The same for a text that is no file; name appears in diagnostics.
std::string expand_kernel_text(std::string_view name, std::string_view text);

}  // namespace obscura
