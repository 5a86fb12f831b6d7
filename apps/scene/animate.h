// Animation channels at a moment.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "apps/scene/scene.h"

namespace limn::scene {

/// The value of a channel with channel.components components at `seconds`. Quaternions are not brought to length 1.
void sampleChannel(const AnimationChannel& channel, double seconds, std::span<double> value);

}  // namespace limn::scene
