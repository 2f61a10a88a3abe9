#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace glint {
namespace {

std::string LibrariesOf(const std::string& program) {
  const std::string command = "ldd " GLINT_BIN_DIR "/" + program + " 2>&1";
  std::string text;
  FILE* output = popen(command.c_str(), "r");
  if (output == nullptr) return text;
  char line[512];
  while (std::fgets(line, sizeof line, output) != nullptr) text += line;
  pclose(output);
  return text;
}

// OpenImageIO and OpenCV bring 260 libraries, which take a third of a second to load: once for
// every command that a person types and for every stage that a run starts.
TEST(Start, WhatOnlyStartsOtherProgramsLoadsNoImageLibraries) {
  for (const std::string program : {"glint", "fake_stage"}) {
    const std::string libraries = LibrariesOf(program);
    EXPECT_NE(libraries.find("libstdc++"), std::string::npos) << libraries;
    for (const std::string heavy : {"libOpenImageIO", "libopencv", "libavcodec", "libtorch"}) {
      EXPECT_EQ(libraries.find(heavy), std::string::npos) << program << " loads " << heavy;
    }
  }
}

// What stages write is EXR and PNG, for which OpenEXR and libpng are enough.
TEST(Start, WhatReadsNoPhotographLoadsNoDecodersOfPhotographs) {
  for (const std::string program : {"glint-refine", "glint-export", "glint-report"}) {
    const std::string libraries = LibrariesOf(program);
    EXPECT_NE(libraries.find("libOpenEXR"), std::string::npos) << libraries;
    for (const std::string heavy : {"libOpenImageIO", "libopencv_imgcodecs", "libgdal", "libraw"}) {
      EXPECT_EQ(libraries.find(heavy), std::string::npos) << program << " loads " << heavy;
    }
  }
  // libtorch brings OpenCV's decoders.
  EXPECT_EQ(LibrariesOf("glint-fit").find("libOpenImageIO"), std::string::npos);
}

}  // namespace
}  // namespace glint
