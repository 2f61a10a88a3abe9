// Whether a JPEG file is all there.
#pragma once

#include <string_view>

namespace glint {

// False for the bytes of a JPEG whose first picture does not reach its end-of-image marker
// (ITU-T T.81, annex B). libjpeg fills what is missing with grey and only warns. What phones append
// after the first picture is not looked at; bytes that are no JPEG are complete.
bool JpegIsComplete(std::string_view bytes);

}  // namespace glint
