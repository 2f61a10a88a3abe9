#include "datasets/looks/looks_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr LooksBand kBands[] = {{"1_2", "1–2"}, {"2_4", "2–4"}, {"4_8", "4–8"}, {"8_16", "8–16"}};

const LooksFigure kFigures[] = {
    {.key = "free",
     .heading = "free",
     .values = [](Looks& l) -> std::span<double> { return std::span(&l.free, 1); },
     .says = "the log error that remains after the best factor of each colour channel: what is not "
             "exposure (0.02: 2 %).",
     .definition = "log-L1 of eq. 2 after the best factor of each channel, where the photograph's "
                   "brightest channel is below 252 of 255",
     .interpretation = "the error apart from exposure, which is unknown for a held-out photograph; "
                       "0 is best",
     .decimals = 4,
     .overall = true},
    {.key = "contrast",
     .heading = "contrast",
     .bands = kBands,
     .values = [](Looks& l) -> std::span<double> { return l.contrast; },
     .says = "how strong fine detail is, rendering by photograph: below 1 the rendering is "
             "blurred, above 1 harsh or noisy.",
     .definition = "standard deviation of log luminance in a band, rendering / photograph; detail "
                   "of 1–2, 2–4, 4–8, 8–16 texels at 256 across, in proportion at other sizes",
     .interpretation = "below 1 blurred or flat, above 1 noisy or harsh"},
    {.key = "correlation",
     .heading = "correlation",
     .bands = std::span(kBands).first<3>(),
     .values = [](Looks& l) -> std::span<double> { return l.correlation; },
     .says = "whether that detail is the photograph's: 1 all of it, 0 none.",
     .definition = "of the finest three bands, at most 256 texels across, after the best shift by "
                   "at most 3 texels",
     .interpretation = "1: the detail is the photograph's; 0: it is other detail. Contrast of 1 "
                       "with a low correlation is invented"},
    {.key = "ssim",
     .heading = "SSIM",
     .values = [](Looks& l) -> std::span<double> { return std::span(&l.ssim, 1); },
     .says = "structural similarity of the two as grey pictures: 1 the same picture.",
     .definition = "structural similarity of the grey pictures (11 × 11, σ 1.5)",
     .interpretation = "1: identical",
     .overall = true},
    {.key = "highlight",
     .heading = "highlight",
     .values = [](Looks& l) -> std::span<double> { return std::span(&l.highlight, 1); },
     .says = "how bright the rendering is where the photograph is brightest (2 % of it), rendering "
             "by photograph: below 1 highlights are too dull.",
     .definition = "mean luminance of the 2 % where the photograph is brightest, rendering / "
                   "photograph",
     .interpretation = "below 1 dull: highlights are too broad, too weak or in another place"},
};

double MeanOfKnown(std::span<const Looks> looks, const LooksColumn& column) {
  double sum = 0, known = 0;
  for (const Looks& one : looks) {
    const double figure = column.ValueOf(one);
    if (std::isnan(figure)) continue;
    sum += figure;
    known += 1;
  }
  return known > 0 ? sum / known : Looks::kUnknown;
}

}  // namespace

std::span<const LooksFigure> LooksFigures() { return kFigures; }

std::string LooksColumn::key() const {
  return figure->bands.empty() ? figure->key
                               : fmt::format("{}_{}", figure->key, figure->bands[band].key);
}

std::string LooksColumn::heading() const {
  return figure->bands.empty() ? figure->heading
                               : fmt::format("{} {}", figure->heading, figure->bands[band].heading);
}

double LooksColumn::ValueOf(Looks looks) const { return figure->values(looks)[band]; }

std::vector<LooksColumn> ColumnsOf(const LooksFigure& figure, size_t most_bands) {
  std::vector<LooksColumn> columns;
  const size_t count = figure.bands.empty() ? 1 : std::min(figure.bands.size(), most_bands);
  for (size_t band = 0; band < count; ++band) columns.push_back({&figure, band});
  return columns;
}

std::vector<LooksColumn> LooksColumns(size_t most_bands) {
  std::vector<LooksColumn> columns;
  for (const LooksFigure& figure : kFigures) {
    for (const LooksColumn& column : ColumnsOf(figure, most_bands)) columns.push_back(column);
  }
  return columns;
}

Looks MeanLooks(std::span<const Looks> looks) {
  Looks mean;
  for (const LooksColumn& column : LooksColumns()) {
    column.figure->values(mean)[column.band] = MeanOfKnown(looks, column);
  }
  return mean;
}

Json ToJson(const Looks& looks) {
  Json json = Json::object();
  for (const LooksColumn& column : LooksColumns()) {
    const double figure = column.ValueOf(looks);
    const Json value = std::isnan(figure) ? Json() : Json(figure);
    if (column.figure->bands.empty()) {
      json[column.figure->key] = value;
    } else {
      json[column.figure->key].push_back(value);
    }
  }
  return json;
}

std::string LooksText(double figure, int decimals) {
  return std::isnan(figure) ? "–" : fmt::format("{:.{}f}", figure, decimals);
}

int LooksWidth(const std::string& heading) {
  constexpr int kFigureWidth = 6;
  const auto characters = std::count_if(heading.begin(), heading.end(), [](unsigned char c) {
    return (c & 0xC0) != 0x80;  // those of UTF-8 that continue no character
  });
  return std::max(kFigureWidth, static_cast<int>(characters));
}

}  // namespace glint
