// What of a JPEG file a decoder needs to see.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// The file without the segments that neither its picture nor its EXIF needs: comments, XMP, IPTC,
// colour profiles, makers' own, and bytes between segments. OpenImageIO reads some of them beyond
// their end where their lengths are wrong. Kept are JFIF (APP0), EXIF (APP1) and Adobe's colour
// transform (APP14), tables, and all from the picture's data on. A segment that does not fit into
// the file ends it.
std::string WithPictureSegmentsAlone(std::string_view jpeg);

// The colour profile that its APP2 segments hold (ICC.1:2010, annex B.4); empty: none, or not all
// of it.
std::string IccOfJpeg(std::string_view jpeg);

}  // namespace glint
