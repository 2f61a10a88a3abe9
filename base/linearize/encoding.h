// How a photograph's stored values encode radiance, and back.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/images/image.h"
#include "base/linearize/response_curve.h"
#include "base/photos/photo.h"
#include "base/photos/photo_name.h"

namespace glint {

class Encoding {
 public:
  enum Kind {
    kLinear,
    kSrgb,     // IEC 61966-2-1
    kGamma22,  // radiance = value^2.2: what flash-capture data sets and phones' JPEGs are read as
    kResponse  // measured: a curve per channel
  };
  Encoding(Kind kind) : kind_(kind) {}  // NOLINT: the named ones stand for themselves
  explicit Encoding(ResponseCurve curve)
      : kind_(kResponse), curve_(std::make_shared<const ResponseCurve>(std::move(curve))) {}

  Kind kind() const { return kind_; }
  const ResponseCurve& curve() const { return *curve_; }  // of kResponse alone
  friend bool operator==(const Encoding& a, const Encoding& b) {
    return a.kind_ == b.kind_ && a.curve_ == b.curve_;
  }

 private:
  Kind kind_;
  std::shared_ptr<const ResponseCurve> curve_;
};

// "linear" (also "none"), "srgb", "gamma2.2"; nullopt: none of these ("auto" included).
std::optional<Encoding> EncodingFromName(std::string_view name);
std::string_view EncodingName(const Encoding& encoding);  // "response" for measured ones

// Scalar curves on [0, ∞); negative values give 0. Above 1 they go on by the same formula. The
// channel (0 R, 1 G, 2 B) matters to measured curves alone.
float LinearFromEncoded(const Encoding& encoding, float value, int channel = 1);
float EncodedFromLinear(const Encoding& encoding, float value, int channel = 1);

// Linear value of code i of `codes` (256 or 65536): code codes − 1 is 1.
std::vector<float> LinearTable(const Encoding& encoding, int codes, int channel = 1);

// Whether the name is that of a file with a response curve.
bool IsResponseFileName(const std::string& name);

// The encoding of one photograph. `name` is "auto", a name that EncodingFromName knows, or the path
// of a response curve (….json); "auto" is linear for floats and camera RAW files, and for 8 and 16
// bit the curve of its colour profile, if that has one that is not sRGB's, or gamma 2.2. RAW and
// floats are linear by nature: a response curve, which is measured on what the camera developed, is
// not for them. Throws UserError for others.
Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file,
                         const Photo& photo);
// Of one without a colour profile.
Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file, int bits);

}  // namespace glint
