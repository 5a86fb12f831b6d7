// What glTF 2.0 says of the members that limn reads: names, types, ranges, references.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace limn::scene::schema {

enum class Kind {
  kText,
  kWord,  ///< one of `words`
  kFlag,
  kWhole,     ///< whole number in [low, high]
  kNumber,    ///< finite number in [low, high]
  kIndex,     ///< of an element of the root's array `words[0]`
  kIndexMap,  ///< names to such indices
  kObject,    ///< with the members `fields`
};

struct Field {
  std::string_view name;
  Kind kind = Kind::kText;
  bool required = false;
  bool isArray = false;
  std::size_t length = 0;  ///< of an array that has a fixed one
  double low = 0.0, high = 0.0;
  std::span<const std::string_view> words{};
  std::span<const Field> fields{};
};

/// The members of the whole file.
std::span<const Field> root();

/// Extensions that limn implements.
std::span<const std::string_view> knownExtensions();

}  // namespace limn::scene::schema
