// Based on: glTF 2.0 specification, sections 3.5 "Scenes" and 3.10 "Cameras", and KHR_lights_punctual.
#include "apps/scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "apps/scene/pose.h"

namespace limn::scene {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

// The parent of every node of the file.
std::vector<std::uint32_t> parentsOf(const GltfDocument& document) {
  const auto& nodes = document.model.nodes;
  std::vector<std::uint32_t> parents(nodes.size(), kNone);
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t c = 0; c < nodes[n].children.size(); ++c) {
      const std::size_t child = static_cast<std::size_t>(nodes[n].children[c]);
      if (parents[child] != kNone) {
        document.refuse(jsonPointer("nodes", n, "children", c),
                        "node " + std::to_string(child) + " is a child of node " +
                            std::to_string(parents[child]) + " already; a node has one parent");
      }
      parents[child] = n;
    }
  }
  return parents;
}

// The nodes in an order with parents first. With one parent each, what no root leads to lies on or below a
// cycle.
std::vector<std::uint32_t> parentsFirst(const GltfDocument& document,
                                        const std::vector<std::uint32_t>& parents) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t n = 0; n < parents.size(); ++n) {
    if (parents[n] == kNone) order.push_back(n);
  }
  std::vector<bool> isReached(parents.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    isReached[order[i]] = true;
    for (const int child : document.model.nodes[order[i]].children)
      order.push_back(static_cast<std::uint32_t>(child));
  }
  const auto lost = std::find(isReached.begin(), isReached.end(), false);
  if (lost != isReached.end()) {
    document.refuse(jsonPointer("nodes", lost - isReached.begin(), "children"),
                    "the node is its own ancestor; nodes must form a tree");
  }
  return order;
}

glm::dmat4 checkedAffine(const GltfDocument& document, const double* columns, const std::string& place) {
  glm::dmat4 matrix;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) matrix[c][r] = columns[4 * c + r];
  }
  constexpr double kRounding = 1e-6;
  for (int c = 0; c < 4; ++c) {
    if (std::abs(matrix[c][3] - (c == 3 ? 1.0 : 0.0)) > kRounding) {
      document.refuse(place, "is no affine matrix; its last row must be 0 0 0 1 (numbers 4, 8, 12, 16)");
    }
    matrix[c][3] = c == 3 ? 1.0 : 0.0;
  }
  return matrix;
}

Node readNode(GltfDocument& document, std::size_t index) {
  const tinygltf::Node& source = document.model.nodes[index];
  Node node;
  node.name = source.name;
  if (!source.matrix.empty())
    node.matrix = checkedAffine(document, source.matrix.data(), jsonPointer("nodes", index, "matrix"));
  if (!source.translation.empty())
    node.translation = {source.translation[0], source.translation[1], source.translation[2]};
  if (!source.scale.empty()) node.scale = {source.scale[0], source.scale[1], source.scale[2]};
  if (!source.rotation.empty()) {
    const auto& q = source.rotation;  // glTF has w last
    node.rotation = unitQuaternion({q[3], q[0], q[1], q[2]});
    if (q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) {
      document.notice("Node " + std::to_string(index) + ": a rotation of length 0 was left out.");
    }
  }
  node.mesh = source.mesh;
  node.skin = source.skin;
  node.camera = source.camera;
  const auto light = source.extensions.find("KHR_lights_punctual");
  if (light != source.extensions.end()) node.light = light->second.Get("light").GetNumberAsInt();
  for (const double weight : source.weights) node.weights.push_back(static_cast<float>(weight));
  return node;
}

// Which nodes the file's scene draws.
std::vector<bool> nodesInScene(GltfDocument& document, const std::vector<std::uint32_t>& parents,
                               const std::vector<std::uint32_t>& order) {
  const auto& scenes = document.model.scenes;
  std::vector<bool> isDrawn(parents.size(), scenes.empty());
  if (scenes.empty()) return isDrawn;
  const std::size_t drawn =
      document.model.defaultScene < 0 ? 0 : static_cast<std::size_t>(document.model.defaultScene);
  if (scenes.size() > 1) {
    document.notice("The file has " + std::to_string(scenes.size()) + " scenes; scene " +
                    std::to_string(drawn) + " is drawn.");
  }
  for (const int root : scenes[drawn].nodes) isDrawn[static_cast<std::size_t>(root)] = true;
  for (const std::uint32_t n : order) {
    if (parents[n] != kNone && isDrawn[parents[n]]) isDrawn[n] = true;
  }
  return isDrawn;
}

Camera readCamera(const GltfDocument& document, std::size_t index) {
  const tinygltf::Camera& source = document.model.cameras[index];
  Camera camera;
  camera.name = source.name;
  camera.perspective = source.type == "perspective";
  const double zfar = camera.perspective ? source.perspective.zfar : source.orthographic.zfar;
  camera.nearPlane = camera.perspective ? source.perspective.znear : source.orthographic.znear;
  if (zfar > 0.0) {
    if (!(zfar > camera.nearPlane))
      document.refuse(jsonPointer("cameras", index, source.type, "zfar"), "must be larger than znear");
    camera.farPlane = zfar;
  }
  if (camera.perspective) {
    camera.yfov = source.perspective.yfov;
    camera.aspect = source.perspective.aspectRatio;
    if (!(camera.yfov > 0.0 && camera.yfov < std::numbers::pi)) {
      document.refuse(jsonPointer("cameras", index, "perspective", "yfov"), "must lie between 0 and pi");
    }
  } else {
    camera.xmag = std::abs(source.orthographic.xmag);
    camera.ymag = std::abs(source.orthographic.ymag);
    if (camera.xmag == 0.0 || camera.ymag == 0.0) {
      document.refuse(jsonPointer("cameras", index, "orthographic"), "xmag and ymag must not be 0");
    }
  }
  return camera;
}

Light readLight(const tinygltf::Light& source) {
  using Kind = raster::Light::Kind;
  Light light;
  light.name = source.name;
  light.kind = source.type == "point"  ? Kind::kPoint
               : source.type == "spot" ? Kind::kSpot
                                       : Kind::kDirectional;
  if (source.color.size() == 3) light.color = {source.color[0], source.color[1], source.color[2]};
  light.color = glm::max(light.color, glm::dvec3(0.0)) * source.intensity;
  light.range = source.range;
  if (light.kind == Kind::kSpot) {
    light.outerCone = std::clamp(source.spot.outerConeAngle, 0.0, std::numbers::pi / 2);
    light.innerCone = std::clamp(source.spot.innerConeAngle, 0.0, light.outerCone);
  }
  return light;
}

}  // namespace

std::vector<std::uint32_t> readNodes(GltfDocument& document, Scene& scene) {
  const std::vector<std::uint32_t> parents = parentsOf(document);
  const std::vector<std::uint32_t> order = parentsFirst(document, parents);
  const std::vector<bool> isDrawn = nodesInScene(document, parents, order);
  std::vector<std::uint32_t> nodeOf(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) nodeOf[order[i]] = i;
  for (const std::uint32_t n : order) {
    Node node = readNode(document, n);
    if (parents[n] != kNone) node.parent = static_cast<std::int32_t>(nodeOf[parents[n]]);
    scene.nodes.push_back(std::move(node));
    scene.inScene.push_back(isDrawn[n]);
  }
  for (std::size_t i = 0; i < document.model.cameras.size(); ++i)
    scene.cameras.push_back(readCamera(document, i));
  for (const tinygltf::Light& light : document.model.lights) scene.lights.push_back(readLight(light));
  return nodeOf;
}

void checkWorldTransforms(const GltfDocument& document, const Scene& scene,
                          const std::vector<std::uint32_t>& nodeOf) {
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  for (std::size_t n = 0; n < nodeOf.size(); ++n) {
    if (isBeyondNumbers(pose.nodeToWorld[nodeOf[n]]))
      document.refuse(jsonPointer("nodes", n),
                      "its transforms multiply to numbers beyond 1e30; scale the scene down");
  }
}

}  // namespace limn::scene
