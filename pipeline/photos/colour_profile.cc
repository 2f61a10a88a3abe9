#include "pipeline/photos/colour_profile.h"

#include <lcms2.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/colour/srgb.h"

namespace glint {
namespace {

constexpr int kCodes = 256;
// Rounding of a profile's numbers: s15Fixed16 of primaries, curves of few points.
constexpr double kSamePrimaries = 0.004, kSameCurve = 0.006;

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

using Primaries = Eigen::Matrix3d;  // XYZ under D50 of R, G and B, in columns

// Rec.709's as sRGB profiles have them (adapted to D50 by Bradford's matrix).
Primaries Rec709() {
  Primaries rec709;
  rec709 << 0.436065674, 0.385147095, 0.143066406,  //
      0.222488403, 0.716873169, 0.060607910,        //
      0.013916016, 0.097076416, 0.714096069;
  return rec709;
}

void SetPrimaries(const Primaries& xyz_from_rgb, ColourProfile* profile) {
  const Eigen::Matrix3d rec709_from_rgb = Rec709().inverse() * xyz_from_rgb;
  if ((rec709_from_rgb - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kSamePrimaries) {
    return;
  }
  // White stays white, whatever a profile's last digits say.
  for (int i = 0; i < 3; ++i) {
    const double sum = rec709_from_rgb.row(i).sum();
    for (int j = 0; j < 3; ++j) {
      profile->rec709_from_rgb.of[static_cast<std::size_t>(3 * i + j)] =
          static_cast<float>(rec709_from_rgb(i, j) / sum);
    }
  }
}

std::string NameOf(void* profile) {
  char text[256] = {};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text, sizeof text);
  std::string name = text;
  std::erase_if(name, [](unsigned char c) { return c < 0x20 || c > 0x7e; });
  return name.empty() ? "unnamed" : name;
}

bool IsSrgbs(const std::vector<float>& curve) {
  for (int i = 0; i < kCodes; ++i) {
    const double srgb = LinearFromSrgb(static_cast<double>(i) / (kCodes - 1));
    if (std::abs(curve[static_cast<std::size_t>(i)] - srgb) > kSameCurve) return false;
  }
  return true;
}

// From 0 to 1 and never falling; empty where it is not.
std::vector<float> CurveOf(void* profile, cmsTagSignature tag) {
  const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(profile, tag));
  if (curve == nullptr) return {};
  std::vector<float> values;
  for (int i = 0; i < kCodes; ++i) {
    values.push_back(cmsEvalToneCurveFloat(curve, static_cast<float>(i) / (kCodes - 1)));
  }
  const bool rises = std::is_sorted(values.begin(), values.end());
  const bool ends = std::abs(values.front()) < 0.01f && std::abs(values.back() - 1) < 0.01f;
  if (!rises || !ends) return {};
  values.front() = 0;
  values.back() = 1;
  return values;
}

ColourProfile NotUsed(ColourProfile profile, const std::string& why) {
  profile.ignored = why;
  return profile;
}

// CIE xy of R, G, B and white; XYZ under D50.
Primaries FromChromaticities(const std::array<std::array<double, 2>, 4>& xy) {
  const auto xyY = [&](std::size_t i) { return cmsCIExyY{xy[i][0], xy[i][1], 1}; };
  const cmsCIExyY white = xyY(3);
  const cmsCIExyYTRIPLE primaries{xyY(0), xyY(1), xyY(2)};
  cmsToneCurve* linear = cmsBuildGamma(nullptr, 1);
  cmsToneCurve* curves[] = {linear, linear, linear};
  const Profile profile(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(linear);
  Primaries result;
  int column = 0;
  for (const auto tag : {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag}) {
    const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile.get(), tag));
    result.col(column++) << xyz->X, xyz->Y, xyz->Z;
  }
  return result;
}

constexpr std::array<double, 2> kD65 = {0.3127, 0.3290};

}  // namespace

std::string ColourProfile::Description() const {
  if (name.empty()) return "sRGB (assumed)";
  return ignored.empty() ? name : name + " (not used: " + ignored + ")";
}

ColourProfile ReadColourProfile(std::string_view icc) {
  ColourProfile result;
  if (icc.empty()) return result;
  const Profile profile(
      cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size())));
  result.name = "unnamed";
  if (!profile) return NotUsed(result, "damaged");
  result.name = NameOf(profile.get());
  if (cmsGetColorSpace(profile.get()) != cmsSigRgbData) {
    return NotUsed(result, "not of RGB pictures");
  }
  if (!cmsIsMatrixShaper(profile.get())) return NotUsed(result, "a table");
  Primaries xyz_from_rgb;
  int column = 0;
  for (const auto tag : {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag}) {
    const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile.get(), tag));
    if (xyz == nullptr) return NotUsed(result, "damaged");
    xyz_from_rgb.col(column++) << xyz->X, xyz->Y, xyz->Z;
  }
  const double determinant = xyz_from_rgb.determinant();
  if (!std::isfinite(determinant) || std::abs(determinant) < 1e-3) {
    return NotUsed(result, "damaged");
  }
  const std::array<cmsTagSignature, 3> tags = {cmsSigRedTRCTag, cmsSigGreenTRCTag,
                                               cmsSigBlueTRCTag};
  std::array<std::vector<float>, 3> curves;
  for (std::size_t c = 0; c < 3; ++c) curves[c] = CurveOf(profile.get(), tags[c]);
  if (std::ranges::any_of(curves, &std::vector<float>::empty)) return NotUsed(result, "damaged");
  if (!std::ranges::all_of(curves, IsSrgbs)) result.curve = curves;
  SetPrimaries(xyz_from_rgb, &result);
  return result;
}

ColourProfile ProfileOfPrimaries(int h273) {
  constexpr int kRec2020 = 9, kDisplayP3 = 12;
  ColourProfile profile;
  if (h273 == kDisplayP3) {
    profile.name = "Display P3";
    SetPrimaries(FromChromaticities({{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65}}),
                 &profile);
  } else if (h273 == kRec2020) {
    profile.name = "Rec. 2020";
    SetPrimaries(FromChromaticities({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65}}),
                 &profile);
  }
  return profile;
}

ColourProfile AdobeRgbProfile() {
  ColourProfile profile;
  profile.name = "Adobe RGB (1998)";
  SetPrimaries(FromChromaticities({{{0.640, 0.330}, {0.210, 0.710}, {0.150, 0.060}, kD65}}),
               &profile);
  constexpr double kGamma = 563.0 / 256;
  for (std::vector<float>& channel : profile.curve) {
    for (int i = 0; i < kCodes; ++i) {
      channel.push_back(
          static_cast<float>(std::pow(static_cast<double>(i) / (kCodes - 1), kGamma)));
    }
  }
  return profile;
}

}  // namespace glint
