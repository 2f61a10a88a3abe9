#include "pipeline/studio/page/page_files.h"

namespace glint {
namespace {

// Each with one byte more, so that none is of no size.
constexpr unsigned char kStudioHtml[] = {
#include "studio.html.inc"
    0};
constexpr unsigned char kPhoneHtml[] = {
#include "phone.html.inc"
    0};
constexpr unsigned char kStudioScript[] = {
#include "studio.bundle.js.inc"
    0};
constexpr unsigned char kPhoneScript[] = {
#include "phone.bundle.js.inc"
    0};
constexpr unsigned char kStyle[] = {
#include "studio.css.inc"
    0};
constexpr unsigned char kIcon[] = {
#include "icon.svg.inc"
    0};

template <size_t kSize>
std::string_view BytesOf(const unsigned char (&bytes)[kSize]) {
  return {reinterpret_cast<const char*>(bytes), kSize - 1};
}

}  // namespace

PageFile FindPageFile(const std::string& name) {
  if (name == "studio.html") return {BytesOf(kStudioHtml), "text/html; charset=utf-8"};
  if (name == "phone.html") return {BytesOf(kPhoneHtml), "text/html; charset=utf-8"};
  if (name == "studio.bundle.js") return {BytesOf(kStudioScript), "text/javascript; charset=utf-8"};
  if (name == "phone.bundle.js") return {BytesOf(kPhoneScript), "text/javascript; charset=utf-8"};
  if (name == "studio.css") return {BytesOf(kStyle), "text/css; charset=utf-8"};
  if (name == "icon.svg") return {BytesOf(kIcon), "image/svg+xml"};
  return {};
}

}  // namespace glint
