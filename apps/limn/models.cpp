// limn models: the built-in models.
#include <algorithm>
#include <iomanip>
#include <iostream>

#include "apps/limn/commands.h"
#include "apps/scene/load.h"

namespace limn::program {

int models() {
  const std::vector<scene::BuiltinModel> all = scene::builtinModels();
  std::size_t width = 0;
  for (const scene::BuiltinModel& model : all) width = std::max(width, model.name.size());
  for (const scene::BuiltinModel& model : all)
    std::cout << "builtin:" << std::left << std::setw(static_cast<int>(width) + 2) << model.name
              << model.description << '\n';
  std::cout << std::flush;
  return kDone;
}

}  // namespace limn::program
