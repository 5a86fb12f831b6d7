// How --help looks.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace limn::program {

/// Two columns that fit a window of 96 columns: what to type, and what it means with its default.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool isPositional) const override;
  std::string make_group(std::string group, bool isPositional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
};

}  // namespace limn::program
