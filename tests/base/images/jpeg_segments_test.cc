#include <gtest/gtest.h>

#include "base/images/jpeg_segments.h"

namespace glint {
namespace {

using namespace std::string_literals;

std::string Segment(char marker, const std::string& content) {
  const std::size_t length = content.size() + 2;
  return "\xff"s + marker + static_cast<char>(length >> 8) + static_cast<char>(length & 255) +
         content;
}

const std::string kStart = "\xff\xd8"s;
const std::string kJfif = Segment('\xe0', "JFIF\0-----"s);
const std::string kExif = Segment('\xe1', "Exif\0\0II*\0"s);
const std::string kAdobe = Segment('\xee', "Adobe------"s);
const std::string kTables = Segment('\xdb', std::string(65, 'q'));
const std::string kScan = Segment('\xda', "----") + "picture\xff\0data\xff\xd9"s;

TEST(JpegSegments, WhatThePictureNeedsIsKept) {
  const std::string whole = kStart + kJfif + kExif + kAdobe + kTables + kScan;
  EXPECT_EQ(WithPictureSegmentsAlone(whole), whole);
}

TEST(JpegSegments, WhatOthersWroteIsLeftOut) {
  const std::string xmp = Segment('\xe1', "http://ns.adobe.com/xap/1.0/\0<x/>"s);
  const std::string profile = Segment('\xe2', "ICC_PROFILE\0..."s);
  const std::string iptc = Segment('\xed',
                                   "Photoshop 3.0\0"
                                   "8BIM\4\4\0\0\0\0\xff\xff\x1c\2"s);
  const std::string comment = Segment('\xfe', "made with care");
  EXPECT_EQ(WithPictureSegmentsAlone(kStart + kJfif + xmp + kExif + profile + iptc + kTables +
                                     comment + kScan),
            kStart + kJfif + kExif + kTables + kScan);
}

// Segments look alike within the picture's data.
TEST(JpegSegments, NothingIsLeftOutOfThePicture) {
  const std::string whole = kStart + kScan + Segment('\xfe', "appended by a phone");
  EXPECT_EQ(WithPictureSegmentsAlone(whole), whole);
}

TEST(JpegSegments, BytesBetweenThemHideNone) {
  const std::string iptc = Segment('\xed', "Photoshop 3.0\0"s);
  for (const std::string& between : {"\xff"s, "\xff\xff\xff"s, "\0\0"s, "gap"s, "\xff\0"s,
                                     "\xff\x01"s, "\xff\xd0"s, "\xff\xd7\xff\xd8"s}) {
    EXPECT_EQ(WithPictureSegmentsAlone(kStart + between + iptc + between + kTables + kScan),
              kStart + kTables + kScan);
  }
}

TEST(JpegSegments, ASegmentThatDoesNotFitEndsTheFile) {
  for (const std::string& rest : {"\xff\xfe\xff\xff..."s, "\xff\xfe\0\1..."s, "\xff\xfe"s, ""s}) {
    EXPECT_EQ(WithPictureSegmentsAlone(kStart + kJfif + rest), kStart + kJfif);
  }
}

}  // namespace
}  // namespace glint
