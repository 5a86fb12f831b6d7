// The bytes of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

namespace limn::scene {

/// Reads at most `limit` bytes. Nothing where the file is none or cannot be read.
std::optional<std::vector<std::uint8_t>> readFileBytes(
    const std::filesystem::path& path, std::size_t limit = std::numeric_limits<std::size_t>::max());

}  // namespace limn::scene
