#include "fitting/weights/safetensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

TensorFile Example() {
  std::vector<float> values(24);
  for (size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<float>(i)) * 3;
  TensorFile file;
  file.metadata["channels"] = "1,2";
  file.tensors.push_back(MakeRecord("a.weight", {2, 3, 4}, values, false));
  file.tensors.push_back(MakeRecord("b.bias", {24}, values, true));
  return file;
}

class Safetensors : public testing::Test {
 protected:
  void SetUp() override { WriteTensorFile(path_, Example()); }
  std::string Message() {
    try {
      ReadTensorFile(path_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
  fs::path path_ = folder_.path() / "w.safetensors";
};

TEST_F(Safetensors, RoundTripKeepsNamesShapesAndValues) {
  const TensorFile read = ReadTensorFile(path_);
  EXPECT_EQ(read.metadata.at("channels"), "1,2");
  const TensorRecord* a = read.Find("a.weight");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(a->shape, (std::vector<std::int64_t>{2, 3, 4}));
  EXPECT_EQ(a->bytes, Example().tensors[0].bytes);
  const TensorRecord* b = read.Find("b.bias");
  ASSERT_NE(b, nullptr);
  EXPECT_EQ(b->dtype, "BF16");
  const std::vector<float> exact = RecordValues(*a), rounded = RecordValues(*b);
  for (size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(rounded[i], exact[i], std::abs(exact[i]) / 256);
  }
  EXPECT_EQ(read.Find("c"), nullptr);
}

TEST_F(Safetensors, RoundsHalvesOfBf16ToEven) {
  const float values[] = {1.0f, 1.0f + 1.0f / 256, 1.0f + 3.0f / 256, -2.5f};
  const std::vector<float> back = RecordValues(MakeRecord("x", {4}, values, true));
  EXPECT_EQ(back, (std::vector<float>{1.0f, 1.0f, 1.0f + 4.0f / 256, -2.5f}));
}

TEST_F(Safetensors, EveryTruncationIsRefused) {
  const std::string whole = test::ReadAll(path_);
  for (size_t length = 0; length < whole.size(); length += 7) {
    test::WriteAll(path_, whole.substr(0, length));
    EXPECT_THAT(Message(), testing::HasSubstr("w.safetensors")) << length;
  }
}

TEST_F(Safetensors, AFlippedBitInTheDataIsRefused) {
  std::string bytes = test::ReadAll(path_);
  bytes[bytes.size() - 10] ^= 4;
  test::WriteAll(path_, bytes);
  EXPECT_THAT(Message(), testing::AllOf(testing::HasSubstr("checksum"), testing::HasSubstr("found"),
                                        testing::HasSubstr("again")));
}

TEST_F(Safetensors, HeadersThatLieAreRefused) {
  const auto with_header = [&](const std::string& header) {
    const std::uint64_t length = header.size();
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &length, 8);
    test::WriteAll(path_, bytes + header + std::string(16, 'x'));
    return Message();
  };
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,160]}})"), "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[5],"data_offsets":[0,16]}})"), "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[-4],"data_offsets":[0,16]}})"), "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F99","shape":[4],"data_offsets":[0,16]}})"), "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[4294967296,4294967296,4],)"
                        R"("data_offsets":[0,16]}})"),
            "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[16,0]}})"), "");
  EXPECT_NE(with_header(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,16]},)"
                        R"("b":{"dtype":"F32","shape":[4],"data_offsets":[0,16]}})"),
            "");
  EXPECT_NE(with_header(std::string(100000, '[')), "");
  EXPECT_NE(with_header(R"({"a":3})"), "");
  EXPECT_NE(with_header("[]"), "");
  EXPECT_NE(with_header("{"), "");
  EXPECT_EQ(with_header(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,16]}})"), "");
}

TEST_F(Safetensors, ValuesThatAreNotFiniteAreRefused) {
  TensorFile file;
  const float values[2] = {1.0f, std::nanf("")};
  for (const bool as_bf16 : {false, true}) {
    file.tensors = {MakeRecord("w", {2}, values, as_bf16)};
    WriteTensorFile(path_, file);
    EXPECT_THAT(Message(), testing::HasSubstr("not finite")) << as_bf16;
  }
}

TEST_F(Safetensors, AHugeHeaderLengthIsRefused) {
  std::string bytes = test::ReadAll(path_);
  std::memset(bytes.data(), 0xff, 8);
  test::WriteAll(path_, bytes);
  EXPECT_THAT(Message(), testing::HasSubstr("header"));
}

TEST(SafetensorsFiles, DevicesAreRefusedWithoutReadingThem) {
  try {
    ReadTensorFile("/dev/zero");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("not a file"), std::string::npos) << error.what();
  }
}

TEST_F(Safetensors, AMissingFileIsNamed) {
  path_ = folder_.path() / "none.safetensors";
  EXPECT_THAT(Message(), testing::HasSubstr("none.safetensors"));
}

}  // namespace
}  // namespace glint
