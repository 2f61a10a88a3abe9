// The layout of --help: names and value names, their text beneath, 80 columns wide.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace glint {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool positional) const override;
};

// `text` in lines of at most `width` columns, each after `indent`; ends with a line break.
std::string Wrapped(const std::string& text, const std::string& indent, size_t width);

}  // namespace glint
