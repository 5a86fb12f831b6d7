// The JSON of a glTF file, checked against what the specification says of it, before anything else reads it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace limn::scene {

/// JSON pointer of a place: jsonPointer("accessors", 3, "count") is "/accessors/3/count".
template <class... Steps>
std::string jsonPointer(const Steps&... steps) {
  std::string pointer;
  const auto append = [&](const auto& step) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(step)>>)
      pointer += '/' + std::to_string(step);
    else
      (pointer += '/') += step;
  };
  (append(steps), ...);
  return pointer;
}

/// A name out of a file, fit for a message: in quotes, cut after 60 characters, without control characters.
std::string inQuotes(std::string_view text);

/// Parses and checks: nesting, types, ranges, lengths of fixed arrays, that every reference names something
/// that is there. Whole numbers written as floats become integers. What limn does not know (other members,
/// extras, other extensions) is taken out, so that nothing unchecked goes on; extensions left out are named
/// in `notices`. Throws InputError "FILE: /JSON/POINTER: what; remedy", or "FILE: byte N: ..." where the text
/// is no JSON.
nlohmann::json parseGltfJson(const std::string& file, std::string_view text, std::size_t offset,
                             std::vector<std::string>& notices);

}  // namespace limn::scene
