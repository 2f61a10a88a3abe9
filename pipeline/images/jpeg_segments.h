// What of a JPEG file a decoder needs to see.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// The file without the segments that neither its picture nor its EXIF needs: comments, XMP, IPTC,
// colour profiles, makers' own. OpenImageIO reads some of them beyond their end where their lengths
// are wrong. Kept are JFIF (APP0), EXIF (APP1) and Adobe's colour transform (APP14). What follows
// the first damaged length is kept as it is: the decoder says what is wrong with it.
std::string WithPictureSegmentsAlone(std::string_view jpeg);

}  // namespace glint
