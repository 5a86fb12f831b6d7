#include "apps/limn/values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "apps/scene/image.h"
#include "apps/scene/nearest.h"
#include "raster/base/elementary.h"

namespace limn::program {
namespace {

std::string quoted(std::string_view text) {
  return "'" + std::string(text) + "'";
}

bool readNumber(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool readInteger(std::string_view text, long& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

struct NamedColor {
  std::string_view name;
  std::uint32_t rgb;
};
constexpr std::array<NamedColor, 16> kColors = {{{"black", 0x000000},
                                                 {"silver", 0xc0c0c0},
                                                 {"gray", 0x808080},
                                                 {"white", 0xffffff},
                                                 {"maroon", 0x800000},
                                                 {"red", 0xff0000},
                                                 {"purple", 0x800080},
                                                 {"fuchsia", 0xff00ff},
                                                 {"green", 0x008000},
                                                 {"lime", 0x00ff00},
                                                 {"olive", 0x808000},
                                                 {"yellow", 0xffff00},
                                                 {"navy", 0x000080},
                                                 {"blue", 0x0000ff},
                                                 {"teal", 0x008080},
                                                 {"aqua", 0x00ffff}}};

/// The sRGB transfer function, IEC 61966-2-1.
double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : power((encoded + 0.055) / 1.055, 2.4);
}
double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * power(linear, 1.0 / 2.4) - 0.055;
}

glm::vec4 linearColor(std::uint32_t rgba) {
  const auto channel = [&](int shift) { return static_cast<double>(rgba >> shift & 0xff) / 255.0; };
  return {static_cast<float>(linearFromSrgb(channel(24))), static_cast<float>(linearFromSrgb(channel(16))),
          static_cast<float>(linearFromSrgb(channel(8))), static_cast<float>(channel(0))};
}

/// Reads the digits after "#" as rrggbbaa.
bool readHexColor(std::string_view digits, std::uint32_t& rgba) {
  std::string full(digits);
  if (digits.size() == 3) {
    full.clear();
    for (const char digit : digits) full.append(2, digit);
  }
  if (full.size() == 6) full += "ff";
  const auto [end, error] = std::from_chars(full.data(), full.data() + full.size(), rgba, 16);
  return full.size() == 8 && error == std::errc() && end == full.data() + full.size();
}

template <class Float>
std::string shortestText(Float value) {
  std::array<char, 32> buffer{};
  const Float number = value == Float(0) ? Float(0) : value;  // no -0
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr};
}

[[noreturn]] void refuseFrames(std::string_view item) {
  throw UsageError(quoted(item) + " is no list of frames; write it like 1-10,15,20-40:2");
}

int frameNumber(std::string_view text, std::string_view item) {
  long value = 0;
  if (!readInteger(text, value)) refuseFrames(item);
  if (value < 1 || value > kMostFrames)
    throw UsageError("there is no frame " + std::string(text) + ": the first is 1, the last possible " +
                     std::to_string(kMostFrames));
  return static_cast<int>(value);
}

/// "7", "1-10" or "20-40:2".
FrameRange parseRange(std::string_view item) {
  const std::vector<std::string_view> stepped = split(item, ':');
  const std::vector<std::string_view> ends = split(stepped[0], '-');
  if (stepped.size() > 2 || ends.size() > 2 || (stepped.size() == 2 && ends.size() != 2)) refuseFrames(item);
  FrameRange range;
  range.first = frameNumber(ends.front(), item);
  range.last = frameNumber(ends.back(), item);
  if (stepped.size() == 2) range.step = frameNumber(stepped[1], item);
  if (range.last < range.first)
    throw UsageError("the frames " + quoted(item) + " run backwards; write the smaller number first");
  range.last = range.first + (range.count() - 1) * range.step;
  return range;
}

}  // namespace

double parseNumber(std::string_view text) {
  double value = 0.0;
  if (!readNumber(text, value)) throw UsageError(quoted(text) + " is not a finite number");
  return value;
}

long parseInteger(std::string_view text, long least, long most) {
  long value = 0;
  if (!readInteger(text, value) || value < least || value > most)
    throw UsageError(quoted(text) + " is not a whole number from " + std::to_string(least) + " to " +
                     std::to_string(most));
  return value;
}

glm::dvec3 parseVector(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  glm::dvec3 value(0.0);
  bool good = parts.size() == 3;
  for (int i = 0; good && i < 3; ++i) good = readNumber(parts[static_cast<std::size_t>(i)], value[i]);
  if (!good) throw UsageError(quoted(text) + " is not a point; write three numbers like 1,-2.5,0");
  return value;
}

std::pair<int, int> parseSize(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  long width = 0, height = 0;
  if (parts.size() != 2 || !readInteger(parts[0], width) || !readInteger(parts[1], height))
    throw UsageError(quoted(text) + " is not a size; write WIDTHxHEIGHT, like 1280x800");
  if (std::min(width, height) < 1 || std::max(width, height) > scene::kLargestSize)
    throw UsageError("a picture of " + std::string(text) +
                     " pixels cannot be drawn; width and height are 1 to " +
                     std::to_string(scene::kLargestSize));
  return {static_cast<int>(width), static_cast<int>(height)};
}

glm::vec4 parseColor(std::string_view text) {
  if (text == "transparent") return glm::vec4(0.0f);
  std::uint32_t rgba = 0;
  if (text.starts_with('#')) {
    if (readHexColor(text.substr(1), rgba)) return linearColor(rgba);
    throw UsageError(quoted(text) + " is not a colour; write #rrggbb or #rrggbbaa");
  }
  std::vector<std::string> names = {"transparent"};
  for (const NamedColor& color : kColors) {
    if (color.name == text) return linearColor(color.rgb << 8 | 0xff);
    names.emplace_back(color.name);
  }
  const std::string nearest = scene::nearestName(text, names);
  throw UsageError(quoted(text) + " is not a colour; " +
                   (nearest.empty() ? "write #rrggbb, a basic name like white, or transparent"
                                    : "did you mean " + nearest + "?"));
}

std::string colorText(const glm::vec4& linear) {
  std::string text = "#";
  for (int i = 0; i < 4; ++i) {
    const double encoded = i < 3 ? srgbFromLinear(linear[i]) : static_cast<double>(linear[i]);
    const int byte = std::clamp(static_cast<int>(encoded * 255.0 + 0.5), 0, 255);
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::pair<double, double> parseTimes(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  double from = 0.0, to = 0.0;
  if (parts.size() != 2 || !readNumber(parts[0], from) || !readNumber(parts[1], to) || from > to)
    throw UsageError(quoted(text) +
                     " is not a span of time; write two seconds like 0:2.5, the earlier first");
  return {from, to};
}

std::pair<int, int> parseShard(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, '/');
  long index = 0, count = 0;
  if (parts.size() != 2 || !readInteger(parts[0], index) || !readInteger(parts[1], count) || index < 1 ||
      count < index || count > kMostFrames)
    throw UsageError(quoted(text) + " is no shard; write I/N with I from 1 to N, like 2/8");
  return {static_cast<int>(index), static_cast<int>(count)};
}

FrameList::FrameList(std::vector<FrameRange> ranges) : ranges_(std::move(ranges)) {
  long count = 0;
  for (const FrameRange& range : ranges_) count += range.count();
  if (count > kMostFrames)
    throw UsageError("the list names more than " + std::to_string(kMostFrames) + " frames");
  count_ = static_cast<int>(count);
}

FrameList FrameList::parse(std::string_view text) {
  std::vector<FrameRange> ranges;
  for (const std::string_view item : split(text, ',')) ranges.push_back(parseRange(item));
  FrameList list(std::move(ranges));
  if (list.ranges_.size() > 1) {
    std::vector<int> frames;
    for (int i = 0; i < list.count(); ++i) frames.push_back(list.at(i));
    std::sort(frames.begin(), frames.end());
    const auto twice = std::adjacent_find(frames.begin(), frames.end());
    if (twice != frames.end())
      throw UsageError("the list " + quoted(text) + " names frame " + std::to_string(*twice) + " twice");
  }
  return list;
}

int FrameList::largest() const {
  int largest = 0;
  for (const FrameRange& range : ranges_) largest = std::max(largest, range.last);
  return largest;
}

int FrameList::at(int position) const {
  for (const FrameRange& range : ranges_) {
    if (position < range.count()) return range.first + position * range.step;
    position -= range.count();
  }
  return 0;
}

std::string FrameList::text() const {
  std::string text;
  for (const FrameRange& range : ranges_) {
    if (!text.empty()) text += ',';
    text += std::to_string(range.first);
    if (range.last != range.first) text.append(1, '-').append(std::to_string(range.last));
    if (range.step != 1 && range.last != range.first) text.append(1, ':').append(std::to_string(range.step));
  }
  return text;
}

int parseChoice(std::string_view text, std::span<const std::string> names) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  const std::string nearest = scene::nearestName(text, names);
  throw UsageError(quoted(text) + " is none of " + all +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

std::vector<int> parseChoices(std::string_view text, std::span<const std::string> names) {
  std::vector<int> choices;
  for (;;) {
    const std::size_t comma = text.find(',');
    const int choice = parseChoice(text.substr(0, comma), names);
    if (std::find(choices.begin(), choices.end(), choice) != choices.end())
      throw UsageError(names[static_cast<std::size_t>(choice)] + " is named twice");
    choices.push_back(choice);
    if (comma == std::string_view::npos) return choices;
    text.remove_prefix(comma + 1);
  }
}

std::string numberText(double value) {
  return shortestText(value);
}

std::string numberText(float value) {
  return shortestText(value);
}

std::string vectorText(const glm::dvec3& value) {
  return numberText(value.x) + "," + numberText(value.y) + "," + numberText(value.z);
}

}  // namespace limn::program
