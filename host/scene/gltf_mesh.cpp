// SPDX-License-Identifier: Apache-2.0
// Meshes: primitives of triangles, strips or fans, transformed to world space in double. Only vertices that
// some triangle uses are kept. Triangles without area are dropped and counted.
#include "base/units.h"
#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace obscura {

namespace {

constexpr uint32_t UNUSED = std::numeric_limits<uint32_t>::max();
constexpr size_t MOST_VERTICES = std::numeric_limits<int32_t>::max();  // device buffers count with 32 bits

// Reads, transforms and appends the vertices of one primitive when they are first used.
class PrimitiveReader {
  public:
    PrimitiveReader(GltfReader& reader, const tinygltf::Primitive& primitive, const std::string& place,
                    const M44d& to_world)
        : reader_(reader),
          place_(place),
          to_world_(to_world),
          mapping_(base_color_mapping(reader, primitive.material)) {
        positions_ = view(primitive, "POSITION", 3);
        normals_ = view(primitive, "NORMAL", 3);
        if (mapping_.textured) uvs_ = view(primitive, "TEXCOORD_" + std::to_string(mapping_.set), 2);
        if (mapping_.textured && !uvs_)
            reader_.notices.add("a textured material meets a mesh without texture coordinates", "primitive");
        set_normal_matrix();
        if (positions_) scene_index_.assign(positions_->count(), UNUSED);
    }

    size_t vertex_count() const { return scene_index_.size(); }
    bool mirrored() const { return mirrored_; }

    uint32_t use_vertex(uint32_t index) {
        if (index >= vertex_count())
            reader_.fail(place_, "index {} is outside its {}.", index, counted(vertex_count(), "position"));
        uint32_t& slot = scene_index_[index];
        if (slot == UNUSED) {
            auto& vertices = reader_.scene.vertices;
            if (vertices.size() >= MOST_VERTICES) reader_.fail(place_, "the scene has too many vertices.");
            slot = static_cast<uint32_t>(vertices.size());
            vertices.push_back(read_vertex(index));
        }
        return slot;
    }

  private:
    std::optional<AccessorView> view(const tinygltf::Primitive& primitive, const std::string& attribute,
                                     int components) const {
        const auto found = primitive.attributes.find(attribute);
        if (found == primitive.attributes.end()) return std::nullopt;
        const std::string where = place_ + ": " + attribute;
        AccessorView result(reader_, found->second, where);
        if (result.components() != components ||
            result.component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            reader_.fail(where, "its accessor {} has the wrong type.", found->second);
        if (positions_ && result.count() != positions_->count())
            reader_.fail(where, "it has {} for {}.", counted(result.count(), "element"),
                         counted(positions_->count(), "position"));
        return result;
    }

    // Cofactors of the linear part: the inverse transpose times the determinant, defined even where a scale
    // is zero. A mirroring transform turns triangles over; their winding is turned back, and the sign of the
    // determinant keeps the normals with it.
    void set_normal_matrix() {
        V3d rows[3];
        for (int i = 0; i < 3; ++i)
            rows[i] = V3d(to_world_[i][0], to_world_[i][1], to_world_[i][2]);
        mirrored_ = rows[0].dot(rows[1].cross(rows[2])) < 0;
        for (int i = 0; i < 3; ++i)
            cofactors_[i] = rows[(i + 1) % 3].cross(rows[(i + 2) % 3]) * (mirrored_ ? -1 : 1);
    }

    V3d read_vector(const AccessorView& accessor, uint32_t index) const {
        return {accessor.value(index, 0), accessor.value(index, 1), accessor.value(index, 2)};
    }

    Vertex read_vertex(uint32_t index) const {
        Vertex vertex;
        V3d world;
        to_world_.multVecMatrix(read_vector(*positions_, index), world);
        vertex.position = V3f(world);
        check_finite(V3f(reader_.scene.unit * world), "position", index);
        if (normals_) {
            const V3d local = read_vector(*normals_, index);
            V3d normal = local.x * cofactors_[0] + local.y * cofactors_[1] + local.z * cofactors_[2];
            const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
            if (largest > 0) normal = (normal / largest).normalized();  // no overflow, no underflow
            vertex.normal = V3f(normal);
            check_finite(vertex.normal, "normal", index);
        }
        if (uvs_) {
            const double u = uvs_->value(index, 0), v = uvs_->value(index, 1);
            vertex.uv = V2f(static_cast<float>(mapping_.uu * u + mapping_.vu * v + mapping_.u0),
                            static_cast<float>(mapping_.uv * u + mapping_.vv * v + mapping_.v0));
            check_finite(V3f(vertex.uv.x, vertex.uv.y, 0), "texture coordinate", index);
        }
        return vertex;
    }

    void check_finite(const V3f& value, const char* what, uint32_t index) const {
        if (!std::isfinite(value.x) || !std::isfinite(value.y) || !std::isfinite(value.z))
            reader_.fail(place_, "the {} of vertex {} is not finite.", what, index);
    }

    GltfReader& reader_;
    std::string place_;
    M44d to_world_;
    UvMapping mapping_;
    V3d cofactors_[3];
    bool mirrored_ = false;
    std::optional<AccessorView> positions_, normals_, uvs_;
    std::vector<uint32_t> scene_index_;  // per vertex of the accessor
};

bool has_area(const std::vector<Vertex>& vertices, const std::array<uint32_t, 3>& corners) {
    return edge_product(vertices[corners[0]].position, vertices[corners[1]].position,
                        vertices[corners[2]].position) >= std::numeric_limits<float>::min();
}

// Corner k of triangle t in a list, strip or fan (glTF 2.0 specification, 3.7.2.1).
size_t corner_index(int mode, size_t t, size_t k) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        const size_t odd = t % 2;
        return t + (k == 0 ? 0 : k == 1 ? 1 + odd : 2 - odd);
    }
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return k == 2 ? 0 : t + 1 + k;
    return 3 * t + k;
}

size_t triangle_count(const GltfReader& reader, const std::string& place, int mode, size_t corner_count) {
    if (mode != TINYGLTF_MODE_TRIANGLES) return corner_count < 3 ? 0 : corner_count - 2;
    if (corner_count % 3 != 0)
        reader.fail(place, "its corner count {} is no multiple of three.", corner_count);
    return corner_count / 3;
}

void note_unsupported(GltfReader& reader, const tinygltf::Primitive& primitive) {
    if (primitive.attributes.contains("COLOR_0"))
        reader.notices.add("vertex colours are not supported yet and are ignored", "primitive");
    if (!primitive.targets.empty())
        reader.notices.add("morph targets are not supported; the base shape is used", "primitive");
}

void append_primitive(GltfReader& reader, const tinygltf::Primitive& primitive, const std::string& place,
                      const M44d& to_world, uint32_t object) {
    if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        reader.fail(place, "its mode {} is not one of glTF's.", primitive.mode);
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        reader.notices.add("points and lines are not rendered", "primitive");
        return;
    }
    if (primitive.material >= 0 && static_cast<size_t>(primitive.material) >= reader.model.materials.size())
        reader.fail(place, "material {} does not exist; the file has {}.", primitive.material,
                    reader.model.materials.size());
    note_unsupported(reader, primitive);
    PrimitiveReader vertices(reader, primitive, place, to_world);
    std::optional<AccessorView> indices;
    if (primitive.indices >= 0) {
        indices.emplace(reader, primitive.indices, place + ": indices");
        const int type = indices->component_type();
        if (indices->components() != 1 ||
            (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
             type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
            reader.fail(place, "its indices must be unsigned integers.");
    }
    const size_t corner_count = indices ? indices->count() : vertices.vertex_count();
    const size_t count = triangle_count(reader, place, primitive.mode, corner_count);
    const uint32_t material = use_material(reader, primitive.material);
    for (size_t t = 0; t < count; ++t) {
        std::array<uint32_t, 3> corners{};
        for (size_t k = 0; k < 3; ++k) {
            const size_t at = corner_index(primitive.mode, t, k);
            corners[k] = vertices.use_vertex(indices ? indices->index(at) : static_cast<uint32_t>(at));
        }
        if (vertices.mirrored()) std::swap(corners[1], corners[2]);
        reader.lengths.add(reader.scene, corners);
        if (has_area(reader.scene.vertices, corners))
            reader.scene.triangles.push_back({corners, material, object});
        else if (reader.scene.dropped_triangles++ == 0)
            reader.first_dropped = fmt::format("{}, triangle {}", place, t);
    }
}

std::string primitive_place(const tinygltf::Mesh& mesh, int mesh_index, size_t primitive) {
    const std::string place = gltf_place("mesh", mesh.name, static_cast<size_t>(mesh_index));
    return fmt::format("{} primitive {}", place, primitive);
}

}  // namespace

void append_mesh(GltfReader& reader, int mesh_index, const std::string& node_place, const M44d& to_world,
                 const std::string& object_name) {
    const tinygltf::Mesh& mesh = reader.model.meshes[static_cast<size_t>(mesh_index)];
    const auto object = static_cast<uint32_t>(reader.scene.objects.size());
    const size_t first = reader.scene.triangles.size();
    for (size_t i = 0; i < mesh.primitives.size(); ++i)
        append_primitive(reader, mesh.primitives[i],
                         fmt::format("{}: {}", node_place, primitive_place(mesh, mesh_index, i)), to_world,
                         object);
    const size_t last = reader.scene.triangles.size();
    if (last > MOST_VERTICES)
        reader.fail(gltf_place("mesh", mesh.name, static_cast<size_t>(mesh_index)),
                    "the scene has too many triangles.");
    reader.scene.objects.push_back(
        {object_name, static_cast<uint32_t>(first), static_cast<uint32_t>(last - first)});
}

}  // namespace obscura
