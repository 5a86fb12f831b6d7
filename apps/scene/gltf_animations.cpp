// Based on: glTF 2.0 specification, section 3.11 "Animations".
#include <algorithm>
#include <optional>
#include <utility>

#include "apps/scene/gltf_accessor.h"
#include "apps/scene/gltf_nodes.h"

namespace limn::scene {
namespace {

struct PathOf {
  const char* name;
  ChannelPath path;
  int type;
};
constexpr PathOf kPaths[] = {{"translation", ChannelPath::kTranslation, TINYGLTF_TYPE_VEC3},
                             {"rotation", ChannelPath::kRotation, TINYGLTF_TYPE_VEC4},
                             {"scale", ChannelPath::kScale, TINYGLTF_TYPE_VEC3},
                             {"weights", ChannelPath::kWeights, TINYGLTF_TYPE_SCALAR}};

Interpolation interpolationOf(const std::string& name) {
  if (name == "STEP") return Interpolation::kStep;
  return name == "CUBICSPLINE" ? Interpolation::kCubicSpline : Interpolation::kLinear;
}

class AnimationReader {
 public:
  AnimationReader(GltfDocument& document, std::size_t index, const std::vector<std::uint32_t>& nodeOf,
                  const Scene& scene)
      : document_(document),
        source_(document.model.animations[index]),
        index_(index),
        nodeOf_(nodeOf),
        scene_(scene) {}

  Animation read() {
    Animation animation;
    animation.name = source_.name;
    for (const tinygltf::AnimationChannel& source : source_.channels) {
      if (std::optional<AnimationChannel> channel = readChannel(source)) {
        animation.duration = std::max(animation.duration, static_cast<double>(channel->times.back()));
        animation.channels.push_back(std::move(*channel));
      }
    }
    if (leftOut_ > 0) {
      document_.notice("Animation " + std::to_string(index_) + ": " + std::to_string(leftOut_) +
                       " channels that move nothing limn knows were left out.");
    }
    return animation;
  }

 private:
  std::string samplerPlace(int sampler, const char* member) const {
    return jsonPointer("animations", index_, "samplers", sampler, member);
  }

  /// How many values a key has, 0 where the channel moves nothing.
  std::uint32_t componentsOf(const PathOf& path, const Node& node) const {
    if (path.path != ChannelPath::kWeights) {
      return node.matrix ? 0U
                         : static_cast<std::uint32_t>(
                               tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(path.type)));
    }
    return node.mesh < 0 ? 0U
                         : static_cast<std::uint32_t>(
                               scene_.meshes[static_cast<std::size_t>(node.mesh)].targets.size());
  }

  std::optional<AnimationChannel> readChannel(const tinygltf::AnimationChannel& source) {
    if (static_cast<std::size_t>(source.sampler) >= source_.samplers.size()) {
      document_.refuse(
          jsonPointer("animations", index_, "channels", &source - source_.channels.data(), "sampler"),
          "is " + std::to_string(source.sampler) + ", but the animation has " +
              std::to_string(source_.samplers.size()) + " samplers; they are counted from 0");
    }
    const auto* path = std::find_if(std::begin(kPaths), std::end(kPaths),
                                    [&](const PathOf& p) { return source.target_path == p.name; });
    const std::uint32_t node = nodeOf_[static_cast<std::size_t>(source.target_node)];
    const std::uint32_t components = path == std::end(kPaths) ? 0 : componentsOf(*path, scene_.nodes[node]);
    AnimationChannel channel;
    if (components > 0) readTimes(source.sampler, channel.times);
    if (channel.times.empty()) {
      ++leftOut_;
      return std::nullopt;
    }
    channel.node = node;
    channel.path = path->path;
    channel.components = components;
    channel.interpolation =
        interpolationOf(source_.samplers[static_cast<std::size_t>(source.sampler)].interpolation);
    readValues(source.sampler, path->type, channel);
    return channel;
  }

  void readTimes(int sampler, std::vector<float>& times) const {
    const AccessorReader reader(document_, source_.samplers[static_cast<std::size_t>(sampler)].input);
    const std::string place = samplerPlace(sampler, "input");
    if (reader.components() != 1 || reader.componentType() != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      document_.refuse(place, "its accessor must hold single floats (5126, SCALAR)");
    }
    times = gather<float>(document_, reader, nullptr);
    if (!std::is_sorted(times.begin(), times.end())) document_.refuse(place, "times must ascend");
  }

  void readValues(int sampler, int type, AnimationChannel& channel) const {
    const int accessor = source_.samplers[static_cast<std::size_t>(sampler)].output;
    const AccessorReader reader(document_, accessor);
    const std::string place = samplerPlace(sampler, "output");
    const std::size_t components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    const bool isFloat = reader.componentType() == TINYGLTF_COMPONENT_TYPE_FLOAT;
    if (reader.components() != components || !(isFloat || reader.normalized())) {
      document_.refuse(place, "accessor " + std::to_string(accessor) +
                                  " must hold floats or normalized integers, " + std::to_string(components) +
                                  " per element");
    }
    const std::size_t perKey = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
    const std::size_t values = channel.times.size() * perKey * channel.components,
                      elements = values / components;
    if (reader.count() < elements) {
      document_.refuse(place, "accessor " + std::to_string(accessor) + " has " +
                                  std::to_string(reader.count()) + " elements; " +
                                  std::to_string(channel.times.size()) + " keys need " +
                                  std::to_string(elements));
    }
    document_.charge(values * sizeof(float), place);
    channel.values.resize(values);
    for (std::size_t i = 0; i < elements; ++i) reader.read(i, components, &channel.values[i * components]);
  }

  GltfDocument& document_;
  const tinygltf::Animation& source_;
  std::size_t index_;
  const std::vector<std::uint32_t>& nodeOf_;
  const Scene& scene_;
  std::size_t leftOut_ = 0;
};

}  // namespace

void readAnimations(GltfDocument& document, const std::vector<std::uint32_t>& nodeOf, Scene& scene) {
  for (std::size_t i = 0; i < document.model.animations.size(); ++i) {
    scene.animations.push_back(AnimationReader(document, i, nodeOf, scene).read());
  }
}

}  // namespace limn::scene
