// "Did you mean ...?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace limn::scene {

/// The known name that the fewest insertions, deletions, changes and swaps of neighbours turn `name` into,
/// the first of those; empty where none is near (more than a third of the letters are wrong, and it does not
/// start like `name`).
std::string nearestName(std::string_view name, std::span<const std::string> known);

}  // namespace limn::scene
