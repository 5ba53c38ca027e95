// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_dump.h"

#include "base/error.h"
#include "scene/material.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "the file has the bytes of the memory");
static_assert(sizeof(V3f) == 12 && sizeof(TraceRay) == 28 && sizeof(TraceHit) == 16, "no padding");

constexpr std::array MAGIC{'O', 'B', 'S', 'C', 'R', 'A', 'Y', 'S'};
constexpr uint32_t VERSION = 2;

struct Header {
    std::array<char, 8> magic;
    uint32_t version, zero;
    uint64_t vertices, triangles;
};
static_assert(sizeof(Header) == 32);

struct LaunchHeader {
    uint32_t queue, query;
    uint64_t rays;
};
static_assert(sizeof(LaunchHeader) == 16);

struct Record {
    V3f origin;
    float t_max;
    V3f direction;
    TraceHit hit;
};
static_assert(sizeof(Record) == 44);

}  // namespace

RayDump::RayDump(const std::filesystem::path& path, const std::filesystem::path& shown_as, const Scene& scene)
    : file_(path, shown_as) {
    const Header header{MAGIC, VERSION, 0, scene.vertices.size(), scene.triangles.size()};
    file_.write(&header, sizeof(header));
    for (const Vertex& vertex : scene.vertices)
        file_.write(&vertex.position, sizeof(vertex.position));
    for (const Triangle& triangle : scene.triangles) {
        const std::array<uint32_t, 4> record{triangle.vertex[0], triangle.vertex[1], triangle.vertex[2],
                                             is_pane(scene.materials[triangle.material]) ? 1u : 0u};
        file_.write(record.data(), sizeof(record));
    }
}

void RayDump::add(uint32_t queue, RayQuery query, std::span<const TraceRay> rays,
                  std::span<const TraceHit> hits) {
    OBSCURA_CHECK(rays.size() == hits.size(), "{} rays have {} hits", rays.size(), hits.size());
    const LaunchHeader header{queue, static_cast<uint32_t>(query), rays.size()};
    file_.write(&header, sizeof(header));
    std::vector<Record> records;
    records.reserve(rays.size());
    for (size_t i = 0; i < rays.size(); ++i)
        records.push_back({rays[i].origin, rays[i].t_max, rays[i].direction, hits[i]});
    file_.write(records.data(), records.size() * sizeof(Record));
}

}  // namespace obscura
