// The outer shape of a glTF file: a JSON text, alone or in the chunks of a GLB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::scene {

struct Container {
  std::string_view json;
  std::size_t jsonOffset = 0;                           ///< of the JSON text in the file, for messages
  std::optional<std::span<const std::uint8_t>> binary;  ///< the BIN chunk of a GLB
};

/// Splits a .gltf or .glb, told apart by their first bytes. Borrows from `bytes`. Throws InputError "FILE:
/// byte N: what; remedy" for what is neither, or cut short; what is merely untidy goes to `notices`.
Container splitContainer(const std::string& file, std::span<const std::uint8_t> bytes,
                         std::vector<std::string>& notices);

}  // namespace limn::scene
