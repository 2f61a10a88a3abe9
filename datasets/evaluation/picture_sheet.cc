#include "datasets/evaluation/picture_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"
#include "base/formats/svbrdf_file.h"
#include "datasets/looks/view_error.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kThumb = 96;  // pixels a side
constexpr int kColumns = 5;
constexpr int kTextHeight = 38, kGap = 6;
constexpr double kNameScale = 0.42;  // of the font
constexpr const char* kColumnNames[kColumns] = {"normal", "diffuse", "specular", "roughness",
                                                "rendering"};

unsigned char Display(float value) {
  return static_cast<unsigned char>(
      std::lround(255 * std::pow(std::clamp(value, 0.0f, 1.0f), 1 / 2.2f)));
}

unsigned char Plain(float value) {
  return static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

std::vector<float> Rendered(const SvbrdfMaps& maps, int threads) {
  const ReflectanceConvention convention = ReflectanceConvention::Dir2019();
  const SamplePlane plane{maps.width, maps.height, 2, 2, convention.sampling};
  View view = DirView(0, 0);
  view.light_in_sample_mm = {-0.8, 0.8, kDirHeight};
  std::vector<float> rgb(3 * maps.texels());
  RenderView(maps, plane, view, convention, rgb.data(), threads);
  return rgb;
}

// The five pictures of one material, reduced to thumbs.
std::array<cv::Mat, kColumns> Thumbs(const SvbrdfMaps& maps, int threads) {
  std::array<cv::Mat, kColumns> thumbs;
  const std::vector<float> rendered = Rendered(maps, threads);
  for (cv::Mat& thumb : thumbs) thumb = cv::Mat(maps.height, maps.width, CV_8UC3);
  for (int y = 0; y < maps.height; ++y) {
    for (int x = 0; x < maps.width; ++x) {
      const size_t i = static_cast<size_t>(y) * maps.width + static_cast<size_t>(x);
      for (int c = 0; c < 3; ++c) {
        thumbs[0].at<cv::Vec3b>(y, x)[c] = Plain(0.5f * maps.plane(kNormalX + c)[i] + 0.5f);
        thumbs[1].at<cv::Vec3b>(y, x)[c] = Display(maps.plane(kDiffuseR + c)[i]);
        thumbs[2].at<cv::Vec3b>(y, x)[c] = Display(maps.plane(kSpecularR + c)[i]);
        thumbs[3].at<cv::Vec3b>(y, x)[c] = Plain(maps.plane(kRoughness)[i]);
        thumbs[4].at<cv::Vec3b>(y, x)[c] =
            Display(rendered[static_cast<size_t>(c) * maps.texels() + i]);
      }
    }
  }
  const int way = maps.width > kThumb ? cv::INTER_AREA : cv::INTER_NEAREST;
  for (cv::Mat& thumb : thumbs) cv::resize(thumb, thumb, {kThumb, kThumb}, 0, 0, way);
  return thumbs;
}

// OpenCV's font has plain ASCII only.
std::string Ascii(const std::string& text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "°") == 0) plain += " deg";
    if (text.compare(i, 3, "≥") == 0) plain += ">=";
    if ((text[i] & 0x80) == 0) plain += text[i];
  }
  return plain;
}

// Pixels that the longest of the lines' names needs.
int TextWidth(const std::vector<std::string>& names) {
  constexpr int kLeast = 60;
  int width = kLeast;
  for (const std::string& name : names) {
    const cv::Size size =
        cv::getTextSize(Ascii(name), cv::FONT_HERSHEY_SIMPLEX, kNameScale, 1, nullptr);
    width = std::max(width, size.width);
  }
  return width + 2 * kGap;
}

class Sheet {
 public:
  // `names`: of the lines of all blocks.
  Sheet(int columns, int rows, int lines, const std::vector<std::string>& names)
      : lines_(lines),
        text_width_(TextWidth(names)),
        canvas_(rows * BlockHeight(), columns * BlockWidth(), CV_8UC3, cv::Scalar(255, 255, 255)) {}

  void Title(int column, int row, const std::string& text) {
    const int left = column * BlockWidth(), top = row * BlockHeight();
    Write(text, {left + kGap, top + 15}, 0.5);
    for (int i = 0; i < kColumns; ++i) {
      Write(kColumnNames[i], {left + text_width_ + i * (kThumb + 2), top + kTextHeight - 6}, 0.4);
    }
  }

  void Line(int column, int row, int line, const std::string& name, const SvbrdfMaps* maps,
            int threads) {
    const int left = column * BlockWidth();
    const int top = row * BlockHeight() + kTextHeight + line * (kThumb + 2);
    Write(name, {left + kGap, top + kThumb / 2}, kNameScale);
    if (maps == nullptr) return;
    const auto thumbs = Thumbs(*maps, threads);
    for (int i = 0; i < kColumns; ++i) {
      thumbs[static_cast<size_t>(i)].copyTo(
          canvas_(cv::Rect(left + text_width_ + i * (kThumb + 2), top, kThumb, kThumb)));
    }
  }

  Image ToImage() const { return ImageOf(canvas_); }

 private:
  int BlockWidth() const { return text_width_ + kColumns * (kThumb + 2) + kGap; }
  int BlockHeight() const { return kTextHeight + lines_ * (kThumb + 2) + kGap; }
  void Write(const std::string& text, cv::Point at, double scale) {
    cv::putText(canvas_, Ascii(text), at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(30, 30, 30),
                1, cv::LINE_AA);
  }

  int lines_, text_width_;
  cv::Mat canvas_;
};

}  // namespace

Image DrawBlocks(const std::vector<SheetBlock>& blocks, int threads) {
  size_t lines = 1;
  std::vector<std::string> names;
  for (const SheetBlock& block : blocks) {
    lines = std::max(lines, block.lines.size());
    for (const auto& line : block.lines) names.push_back(line.first);
  }
  Sheet sheet(1, static_cast<int>(blocks.size()), static_cast<int>(lines), names);
  for (int row = 0; row < std::ssize(blocks); ++row) {
    const SheetBlock& block = blocks[static_cast<size_t>(row)];
    sheet.Title(0, row, block.title);
    int line = 0;
    for (const auto& [name, maps] : block.lines) sheet.Line(0, row, line++, name, &maps, threads);
  }
  return sheet.ToImage();
}

Image DrawSheet(const Experiment& experiment, int threads) {
  const int columns = static_cast<int>(experiment.conditions.size());
  const int rows = std::min(kSheetMaterials, static_cast<int>(experiment.materials.size()));
  std::vector<std::string> names{"truth"};
  for (const Method& method : experiment.methods) names.push_back(method.name);
  Sheet sheet(columns, rows, static_cast<int>(names.size()), names);
  for (int row = 0; row < rows; ++row) {
    const MaterialSource material =
        LoadMaterial(experiment.materials[static_cast<size_t>(row)], experiment.size);
    for (int column = 0; column < columns; ++column) {
      const Condition& condition = experiment.conditions[static_cast<size_t>(column)];
      sheet.Title(column, row,
                  material.name + ", N = " + std::to_string(condition.views.count) +
                      (condition.name.empty() ? "" : ", " + condition.name));
      sheet.Line(column, row, 0, "truth", &material.maps, threads);
      int line = 1;
      for (const Method& method : experiment.methods) {
        const fs::path file = ResultManifest(experiment, material.name, condition, method);
        SvbrdfMaps maps;
        if (fs::exists(file)) {
          const FittedMaps result = ReadFittedMaps(file);
          maps = ToUnitWeight(result.maps, result.convention);
        }
        sheet.Line(column, row, line++, method.name, maps.texels() > 0 ? &maps : nullptr, threads);
      }
    }
  }
  return sheet.ToImage();
}

}  // namespace glint
