#include "apps/limn/help.h"

#include <algorithm>
#include <sstream>

namespace limn::program {
namespace {

constexpr std::size_t kLeft = 34, kWidth = 96;

/// `left` in its column, `right` broken into lines beside it.
std::string row(const std::string& left, const std::string& right) {
  std::string text = "  " + left;
  std::size_t column = text.size();
  const std::string indent = '\n' + std::string(kLeft, ' ');
  if (column + 1 > kLeft) {
    text += indent;
    column = kLeft;
  } else {
    text.append(kLeft - column, ' ');
    column = kLeft;
  }
  std::istringstream words(right);
  for (std::string word; words >> word;) {
    if (column > kLeft && column + 1 + word.size() > kWidth) {
      text += indent;
      column = kLeft;
    }
    if (column > kLeft) text += ' ', ++column;
    text += word;
    column += word.size();
  }
  return text + '\n';
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool isPositional) const {
  std::string left = option->get_name(isPositional, true);
  if (!isPositional && !option->get_type_name().empty()) left += " " + option->get_type_name();
  const std::string standard = option->get_default_str();
  return row(left, option->get_description() + (standard.empty() ? "" : " [" + standard + "]"));
}

std::string HelpFormatter::make_group(std::string group, bool isPositional,
                                      std::vector<const CLI::Option*> options) const {
  std::string text = isPositional ? "\n" : "\n" + group + ":\n";
  for (const CLI::Option* option : options) text += make_option(option, isPositional);
  return text;
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return row(command->get_name(), command->get_description());
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
  std::string text = "\nUsage: " + name;
  if (!app->get_options([](const CLI::Option* option) { return option->nonpositional(); }).empty())
    text += " [options]";
  for (const CLI::Option* option : app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
    text += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
  if (!app->get_subcommands([](const CLI::App*) { return true; }).empty()) text += " COMMAND";
  return text + '\n';
}

}  // namespace limn::program
