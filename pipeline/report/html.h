// Small pieces of HTML.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// Text with &, <, >, quotes replaced.
std::string HtmlText(std::string_view text);

// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

// A number as a person reads it: four significant digits, six from 100 on, integers whole.
std::string NumberText(double value);

// The whole page round `body`; its style sheet is inside, nothing is loaded from elsewhere.
std::string HtmlPage(const std::string& title, const std::string& body);

}  // namespace glint
