#include "apps/scene/gltf_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/scene/gltf_schema.h"
#include "apps/scene/load.h"

namespace limn::scene {
namespace {

using nlohmann::json;
using schema::Field;
using schema::Kind;

constexpr std::size_t kDeepest = 64;  // glTF itself nests ten deep; tinygltf descends by recursion
constexpr std::size_t kLongestText = 512U << 20;

// Builds the document, remembers where the text stops being JSON, and goes no deeper than kDeepest.
class TextReader : public nlohmann::detail::json_sax_dom_parser<json> {
 public:
  explicit TextReader(json& document) : json_sax_dom_parser(document, false) {}

  bool start_object(std::size_t length) { return descend() && json_sax_dom_parser::start_object(length); }
  bool end_object() { return --depth_, json_sax_dom_parser::end_object(); }
  bool start_array(std::size_t length) { return descend() && json_sax_dom_parser::start_array(length); }
  bool end_array() { return --depth_, json_sax_dom_parser::end_array(); }
  bool parse_error(std::size_t position, const std::string& /*token*/, const json::exception& error) {
    position_ = position;
    isTooLarge_ = error.id == 406;
    return false;
  }

  std::size_t position() const { return position_; }
  std::string problem() const {
    if (depth_ > kDeepest)
      return "nested more than " + std::to_string(kDeepest) + " deep; glTF needs no such depth";
    if (isTooLarge_) return "a number beyond 1e308; limn takes numbers up to 1e15";
    return "not JSON from here on; is it a whole .gltf or .glb file?";
  }

 private:
  bool descend() { return ++depth_ <= kDeepest; }

  std::size_t depth_ = 0, position_ = 0;
  bool isTooLarge_ = false;
};

json parseText(const std::string& file, std::string_view text, std::size_t offset) {
  if (text.size() > kLongestText)
    throw InputError(file + ": more than 512 MiB of JSON; keep the arrays in a GLB");
  json document;
  TextReader reader(document);
  if (!json::sax_parse(text, &reader)) {
    throw InputError(file + ": byte " + std::to_string(offset + reader.position()) + ": " + reader.problem());
  }
  return document;
}

// A number as a user would write it.
std::string shortNumber(double value) {
  const bool isWhole = std::abs(value) < 1e15 && value == std::floor(value);
  return isWhole ? std::to_string(static_cast<std::int64_t>(value)) : json(value).dump();
}

class SchemaCheck {
 public:
  SchemaCheck(const std::string& file, const json& document) : file_(file) {
    for (const Field& field : schema::root()) {
      if (field.isArray) counts_.emplace_back(field.name, countOf(document, field.name));
    }
    const json::json_pointer lights("/extensions/KHR_lights_punctual");
    if (document.contains(lights)) counts_.emplace_back("lights", countOf(document[lights], "lights"));
  }

  void checkObject(json& value, std::span<const Field> fields) {
    if (!value.is_object()) refuse("is " + nameOf(value) + "; an object { } belongs here");
    for (auto member = value.begin(); member != value.end();) {
      const bool known =
          std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == member.key(); });
      member = known ? std::next(member) : value.erase(member);
    }
    for (const Field& field : fields) {
      const auto member = value.find(field.name);
      if (member == value.end() && field.required) {
        refuse("has no \"" + std::string(field.name) + "\"; the specification wants one");
      }
      if (member == value.end()) continue;
      const Step step(path_, field.name);
      if (field.isArray)
        checkArray(*member, field);
      else
        checkValue(*member, field);
    }
  }

 private:
  // Appends a step to the path for as long as it lives.
  class Step {
   public:
    Step(std::string& path, std::string_view name) : path_(path), length_(path.size()) {
      path_ += '/';
      for (const char c : name) {  // RFC 6901
        if (c == '~')
          path_ += "~0";
        else if (c == '/')
          path_ += "~1";
        else
          path_ += c;
      }
    }
    Step(std::string& path, std::size_t index) : Step(path, std::to_string(index)) {}
    ~Step() { path_.resize(length_); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    std::string& path_;
    std::size_t length_;
  };

  static std::size_t countOf(const json& object, std::string_view name) {
    const auto member = object.find(name);
    return member != object.end() && member->is_array() ? member->size() : 0;
  }

  static std::string nameOf(const json& value) {
    if (value.is_number()) return "the number " + value.dump();
    if (value.is_string()) return "the text " + inQuotes(value.get_ref<const std::string&>());
    return std::string("of type ") + value.type_name();
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(file_ + ": " + (path_.empty() ? "/" : path_) + ": " + what);
  }

  void checkArray(json& value, const Field& field) {
    if (!value.is_array()) refuse("is " + nameOf(value) + "; an array [ ] belongs here");
    if (field.length != 0 && value.size() != field.length) {
      refuse("has " + std::to_string(value.size()) + " elements; it needs " + std::to_string(field.length));
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      const Step step(path_, i);
      checkValue(value[i], field);
    }
  }

  void checkValue(json& value, const Field& field) {
    switch (field.kind) {
      case Kind::kText:
        if (!value.is_string()) refuse("is " + nameOf(value) + "; a text belongs here");
        return;
      case Kind::kWord:
        return checkWord(value, field.words);
      case Kind::kFlag:
        if (!value.is_boolean()) refuse("is " + nameOf(value) + "; true or false belongs here");
        return;
      case Kind::kWhole:
        return checkWhole(value, field.low, field.high);
      case Kind::kNumber:
        return checkNumber(value, field.low, field.high);
      case Kind::kIndex:
        return checkIndex(value, field.words[0]);
      case Kind::kIndexMap:
        return checkIndexMap(value, field.words[0]);
      case Kind::kObject:
        return checkObject(value, field.fields);
    }
  }

  void checkWord(const json& value, std::span<const std::string_view> words) const {
    if (value.is_string() && std::count(words.begin(), words.end(), value.get_ref<const std::string&>()) != 0)
      return;
    std::string list;
    for (const std::string_view word : words) (list += list.empty() ? "" : ", ") += word;
    refuse("is " + nameOf(value) + "; one of " + list + " belongs here");
  }

  void checkNumber(const json& value, double low, double high) const {
    if (!value.is_number()) refuse("is " + nameOf(value) + "; a number belongs here");
    const double number = value.get<double>();
    if (!(number >= low && number <= high)) {
      refuse("is " + value.dump() + "; it must be from " + shortNumber(low) + " to " + shortNumber(high));
    }
  }

  void checkWhole(json& value, double low, double high) const {
    checkNumber(value, low, high);
    const double number = value.get<double>();
    if (number != std::floor(number)) refuse("is " + value.dump() + "; a whole number belongs here");
    value = static_cast<std::uint64_t>(number);  // 3.0 and -0 are whole numbers to glTF, but not to tinygltf
  }

  void checkIndex(json& value, std::string_view array) const {
    checkWhole(value, 0.0, 2147483647.0);
    const std::size_t count = std::find_if(counts_.begin(), counts_.end(), [&](const auto& entry) {
                                return entry.first == array;
                              })->second;
    if (value.get<std::size_t>() < count) return;
    refuse("is " + value.dump() + ", but the file has " + std::to_string(count) + " " + std::string(array) +
           "; they are counted from 0");
  }

  void checkIndexMap(json& value, std::string_view array) {
    if (!value.is_object()) refuse("is " + nameOf(value) + "; an object { } belongs here");
    for (auto member = value.begin(); member != value.end(); ++member) {
      const Step step(path_, member.key());
      checkIndex(*member, array);
    }
  }

  const std::string& file_;
  std::string path_;
  std::vector<std::pair<std::string_view, std::size_t>> counts_;  // of the arrays that are referred to
};

bool isKnownExtension(std::string_view name) {
  const auto known = schema::knownExtensions();
  return std::find(known.begin(), known.end(), name) != known.end();
}

// The texts of an array of texts; what is none is left to the check of the whole.
std::vector<std::string> textsOf(const json& document, const char* name) {
  std::vector<std::string> texts;
  const auto member = document.find(name);
  if (member == document.end() || !member->is_array()) return texts;
  for (const json& text : *member)
    texts.push_back(text.is_string() ? text.get<std::string>() : std::string());
  return texts;
}

void checkExtensions(const std::string& file, const json& document, std::vector<std::string>& notices) {
  const std::vector<std::string> required = textsOf(document, "extensionsRequired");
  for (std::size_t i = 0; i < required.size(); ++i) {
    if (isKnownExtension(required[i])) continue;
    throw InputError(file + ": " + jsonPointer("extensionsRequired", i) +
                     ": the file requires the extension " + inQuotes(required[i]) +
                     ", which limn does not have; export the model without it");
  }
  std::set<std::string> unknown;
  for (std::string& name : textsOf(document, "extensionsUsed")) {
    if (!isKnownExtension(name)) unknown.insert(std::move(name));
  }
  for (const std::string& name : unknown) {
    notices.push_back("The extension " + inQuotes(name) + " is not known to limn and was left out.");
  }
}

void checkVersion(const std::string& file, const json& document) {
  const json::json_pointer version("/asset/version"), minimum("/asset/minVersion");
  const auto refuse = [&](const json::json_pointer& place) {
    throw InputError(file + ": " + place.to_string() + ": is " + document[place].dump() +
                     "; limn reads glTF 2.0, convert the file first");
  };
  const auto isText = [&](const json::json_pointer& p) {
    return document.contains(p) && document[p].is_string();
  };
  if (isText(version) && !document[version].get_ref<const std::string&>().starts_with("2.")) refuse(version);
  if (isText(minimum) && document[minimum] != "2.0") refuse(minimum);
}

}  // namespace

std::string inQuotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result = "\"";
  for (const char c : text.substr(0, kLongest))
    result += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return result + (text.size() > kLongest ? "...\"" : "\"");
}

json parseGltfJson(const std::string& file, std::string_view text, std::size_t offset,
                   std::vector<std::string>& notices) {
  json document = parseText(file, text, offset);
  checkVersion(file,
               document);  // first: another version or an extension explains much that the schema would not
  checkExtensions(file, document, notices);
  SchemaCheck(file, document).checkObject(document, schema::root());
  return document;
}

}  // namespace limn::scene
