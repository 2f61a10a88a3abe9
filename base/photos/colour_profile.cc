#include "base/photos/colour_profile.h"

#include <fmt/format.h>
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
  if (!profile) return Primaries::Zero();  // they lie on a line
  Primaries result = Primaries::Zero();
  int column = 0;
  for (const auto tag : {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag}) {
    const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile.get(), tag));
    if (xyz != nullptr) result.col(column) << xyz->X, xyz->Y, xyz->Z;
    ++column;
  }
  return result;
}

constexpr std::array<double, 2> kD65 = {0.3127, 0.3290};

template <class Linear>
void SetCurve(const Linear& linear, ColourProfile* profile) {
  for (std::vector<float>& channel : profile->curve) {
    channel.clear();
    for (int i = 0; i < kCodes; ++i) {
      channel.push_back(static_cast<float>(linear(static_cast<double>(i) / (kCodes - 1))));
    }
  }
}

// SMPTE ST 2084, 4.1; 1 is 203 cd/m².
double LinearFromPq(double stored) {
  constexpr double kM1 = 2610.0 / 16384, kM2 = 78.84375, kC1 = 0.8359375, kC2 = 18.8515625,
                   kC3 = 18.6875, kPeak = 10000.0 / 203;
  const double power = std::pow(stored, 1 / kM2);
  return kPeak * std::pow(std::max(power - kC1, 0.0) / (kC2 - kC3 * power), 1 / kM1);
}

// Light of the scene by Rec. ITU-R BT.2100, table 5; 1 is what is stored as 0.75.
double LinearFromHlg(double stored) {
  constexpr double kA = 0.17883277, kB = 0.28466892, kC = 0.55991073;
  const auto scene = [](double e) {
    return e <= 0.5 ? e * e / 3 : (std::exp((e - kC) / kA) + kB) / 12;
  };
  return scene(stored) / scene(0.75);
}

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
    return NotUsed(result, "not an RGB profile");
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

ColourProfile ProfileOfCodePoints(int primaries, int transfer) {
  constexpr int kRec2020 = 9, kDisplayP3 = 12, kLinear = 8, kPq = 16, kHlg = 18;
  ColourProfile profile;
  if (primaries == kDisplayP3) {
    profile.name = "Display P3";
    SetPrimaries(FromChromaticities({{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65}}),
                 &profile);
  } else if (primaries == kRec2020) {
    profile.name = "Rec. 2020";
    SetPrimaries(FromChromaticities({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65}}),
                 &profile);
  }
  const auto add = [&profile](const char* curve, double (*linear)(double)) {
    profile.name += (profile.name.empty() ? "Rec. 709, " : ", ") + std::string(curve);
    SetCurve(linear, &profile);
  };
  if (transfer == kLinear) add("linear", [](double stored) { return stored; });
  if (transfer == kPq) add("PQ", LinearFromPq);
  if (transfer == kHlg) add("HLG", LinearFromHlg);
  return profile;
}

ColourProfile ProfileOfGamma(double gamma) {
  constexpr double kUsual = 1 / 2.2, kSame = 0.02, kLeast = 0.2, kMost = 1.5;
  ColourProfile profile;
  if (!(gamma >= kLeast && gamma <= kMost) || std::abs(gamma / kUsual - 1) < kSame) return profile;
  profile.name = fmt::format("gamma {:.3g}", 1 / gamma);
  SetCurve([gamma](double stored) { return std::pow(stored, 1 / gamma); }, &profile);
  return profile;
}

ColourProfile ProfileOfChromaticities(const std::array<float, 8>& xy) {
  ColourProfile profile;
  std::array<std::array<double, 2>, 4> points{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = xy[2 * i], y = xy[2 * i + 1];
    // ACES AP0's blue has y below 0.
    if (!(std::abs(x) < 2 && std::abs(y) < 2 && y != 0)) return profile;
    points[i] = {x, y};
  }
  const Primaries xyz_from_rgb = FromChromaticities(points);
  if (!xyz_from_rgb.allFinite() || std::abs(xyz_from_rgb.determinant()) < 1e-3) return profile;
  SetPrimaries(xyz_from_rgb, &profile);
  if (profile.converts()) {
    profile.name = fmt::format("primaries {:.3g} {:.3g}, {:.3g} {:.3g}, {:.3g} {:.3g}", xy[0],
                               xy[1], xy[2], xy[3], xy[4], xy[5]);
  }
  return profile;
}

ColourProfile AdobeRgbProfile() {
  ColourProfile profile;
  profile.name = "Adobe RGB (1998)";
  SetPrimaries(FromChromaticities({{{0.640, 0.330}, {0.210, 0.710}, {0.150, 0.060}, kD65}}),
               &profile);
  constexpr double kGamma = 563.0 / 256;
  SetCurve([](double stored) { return std::pow(stored, kGamma); }, &profile);
  return profile;
}

}  // namespace glint
