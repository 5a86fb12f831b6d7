// The built-in models.
#pragma once

#include <string>

#include "apps/scene/scene.h"

namespace limn::scene {

/// `name` without "builtin:". Throws InputError for unknown names (with the nearest known one) and absurd
/// resolutions.
Scene makeBuiltin(const std::string& name);

}  // namespace limn::scene
