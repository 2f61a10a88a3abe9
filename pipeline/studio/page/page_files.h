// The files of Studio's pages, which pipeline/studio/app makes.
#pragma once

#include <string>
#include <string_view>

namespace glint {

struct PageFile {
  std::string_view bytes;  // empty: no such file, or this build has no pages
  std::string_view type;   // of its content
};

// "studio.html", "phone.html", "studio.bundle.js", "phone.bundle.js", "studio.css", "icon.svg".
PageFile FindPageFile(const std::string& name);

}  // namespace glint
