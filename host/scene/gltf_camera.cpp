// SPDX-License-Identifier: Apache-2.0
// Cameras of nodes, and the camera that frames a scene which has none. Scale and shear of the node are
// removed, so that camera_to_world is rigid; glTF's xmag, znear and zfar are not used: the picture's size gives
// the aspect (a perspective camera's own one is kept, to warn of another), and rays are not clipped.
#include "scene/gltf_reader.h"

#include <cmath>
#include <numbers>

namespace obscura {

namespace {

// Between a camera's up and its view: less is rounding of the transform's product.
constexpr double SMALLEST_SINE = 1e-12;

// Rigid transform with the given position, looking along -backward, with +y towards up.
M44d rigid(const V3d& right, const V3d& up, const V3d& backward, const V3d& position) {
    return M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, backward.x, backward.y, backward.z, 0,
                position.x, position.y, position.z, 1);
}

}  // namespace

void append_camera(GltfReader& reader, const tinygltf::Node& node, const std::string& node_place,
                   const M44d& to_world) {
    if (node.camera < 0) return;
    const auto& cameras = reader.model.cameras;
    if (static_cast<size_t>(node.camera) >= cameras.size())
        reader.fail(node_place, "camera {} does not exist; the file has {}.", node.camera, cameras.size());
    const tinygltf::Camera& source = cameras[static_cast<size_t>(node.camera)];
    const std::string place = gltf_place("camera", source.name, static_cast<size_t>(node.camera));

    Camera camera;
    camera.name = node.name.empty() ? source.name : node.name;
    if (source.type == "orthographic") {
        camera.orthographic = true;
        camera.half_height = source.orthographic.ymag / reader.scene.unit;
        if (!(camera.half_height > 0) || !std::isfinite(static_cast<float>(camera.half_height)))
            reader.fail(place, "ymag must be positive, not {}.", source.orthographic.ymag);
    } else {
        camera.vertical_fov = source.perspective.yfov;
        camera.aspect_ratio = source.perspective.aspectRatio;
        if (!(camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi))
            reader.fail(place, "yfov must be between 0 and pi, not {}.", camera.vertical_fov);
    }
    V3d up, backward;
    to_world.multDirMatrix(V3d(0, 1, 0), up);
    to_world.multDirMatrix(V3d(0, 0, 1), backward);
    up.normalize();
    backward.normalize();
    V3d right = up.cross(backward);
    const V3d position = to_world.translation();
    if (!(right.length() > SMALLEST_SINE) || !std::isfinite(static_cast<float>(position.length())))
        reader.fail(node_place, "its transform leaves its camera no direction or position.");
    right.normalize();
    camera.camera_to_world = rigid(right, backward.cross(right), backward, position);
    reader.scene.cameras.push_back(camera);
}

Camera default_camera(const Box3f& bounds) {
    Camera camera;
    camera.name = "default";
    const V3d center = bounds.isEmpty() ? V3d(0, 0, 0) : 0.5 * (V3d(bounds.min) + V3d(bounds.max));
    const double radius = bounds.isEmpty() ? 1 : (V3d(bounds.max) - center).length();
    // Three-quarter view from the right and above; the bounding sphere just fits the picture's height.
    const V3d backward = V3d(0.6, 0.45, 1).normalized();
    const double distance = radius / std::sin(camera.vertical_fov / 2);
    const V3d right = V3d(0, 1, 0).cross(backward).normalized();
    camera.camera_to_world = rigid(right, backward.cross(right), backward, center + distance * backward);
    return camera;
}

}  // namespace obscura
