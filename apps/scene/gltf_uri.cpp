// Based on: RFC 2397 (data URIs), RFC 3986 (percent encoding), RFC 4648 (base64).
// Differs in: only the base64 form of data URIs; of RFC 3986 only relative references without query and
// fragment.
#include "apps/scene/gltf_uri.h"

#include <algorithm>
#include <array>
#include <system_error>

namespace limn::scene {
namespace {

namespace fs = std::filesystem;

// Six bits of a base64 digit, or -1.
int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

std::optional<std::vector<std::uint8_t>> decodeBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = base64Value(c);
    if (value < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count & 255U));
  }
  return bytes;
}

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// A per cent sign without two digits after it stands for itself: old exporters do not escape it.
std::string percentDecoded(std::string_view uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped =
        uri[i] == '%' && i + 2 < uri.size() && hexValue(uri[i + 1]) >= 0 && hexValue(uri[i + 2]) >= 0;
    if (!escaped) {
      decoded += uri[i];
      continue;
    }
    decoded += static_cast<char>(hexValue(uri[i + 1]) * 16 + hexValue(uri[i + 2]));
    i += 2;
  }
  return decoded;
}

// "https:", "file:", and a drive "C:" too.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

bool isInside(const fs::path& file, const fs::path& folder) {
  const auto [mismatch, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return mismatch == folder.end();
}

}  // namespace

bool isDataUri(std::string_view uri) {
  return uri.starts_with("data:");
}

std::optional<std::vector<std::uint8_t>> decodeDataUri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!isDataUri(uri) || comma == std::string_view::npos) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  return decodeBase64(uri.substr(comma + 1));
}

std::string uriProblem(std::string_view uri) {
  const std::string name = percentDecoded(uri);
  const fs::path relative(name);
  if (name.empty()) return "names no file";
  if (hasScheme(uri) || hasScheme(name)) return "has a scheme; only files beside the model or below are read";
  const bool isRelative =
      !relative.is_absolute() && name.find('\\') == std::string::npos && name.find('\0') == std::string::npos;
  if (!isRelative) return "is not a relative path; only files beside the model or below are read";
  const bool leadsUp = std::find(relative.begin(), relative.end(), "..") != relative.end();
  return leadsUp ? "leads upward; only files beside the model or below are read" : "";
}

fs::path resolveUri(std::string_view uri, const fs::path& folder, std::string& problem) {
  problem = uriProblem(uri);
  if (!problem.empty()) return {};
  const fs::path relative(percentDecoded(uri));
  const fs::path path = folder / relative;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    problem = "names no file beside the model or below; is it missing?";
    return {};
  }
  fs::path file = fs::canonical(path, error);
  if (error || !isInside(file, fs::canonical(folder, error)) || error)
    problem = "is a link that leads out of the model's folder; copy the file there";
  return file;
}

}  // namespace limn::scene
