#include "apps/scene/load.h"

#include "apps/scene/builtin.h"

namespace limn::scene {

Scene load(const std::string& model, const LoadOptions& options) {
  static_cast<void>(options);
  const std::string prefix = "builtin:";
  if (model.starts_with(prefix)) return makeBuiltin(model.substr(prefix.size()));
  throw InputError(model + ": not a built-in model");
}

}  // namespace limn::scene
