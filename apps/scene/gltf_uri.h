// What a glTF file may refer to: bytes inside it (data URIs) and files beside or below it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::scene {

bool isDataUri(std::string_view uri);

/// Decodes "data:...;base64,...". Nothing where the text is no such URI.
std::optional<std::vector<std::uint8_t>> decodeDataUri(std::string_view uri);

/// What is wrong with the text of a URI, whether it names a file or not: another scheme, an absolute path, "..". Empty: nothing.
std::string uriProblem(std::string_view uri);

/// The file that a relative URI names, percent-decoded, below `folder`: one path for one file, however the URI spells it
/// and whatever links it passes. Returns what is wrong with it in `problem` (empty: nothing): another scheme, an absolute
/// path, "..", a link that leads out of the folder, not a file.
std::filesystem::path resolveUri(std::string_view uri, const std::filesystem::path& folder,
                                 std::string& problem);

}  // namespace limn::scene
