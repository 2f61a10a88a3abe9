#include "training/loss_watch.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/statistics/median.h"

namespace glint {
namespace {

constexpr double kLeastLoss = 1e-12;
constexpr double kNormalPerMad = 1.4826;  // a normal distribution's standard deviation by its MAD

// Column `name` of a CSV file's lines; empty when there is none.
std::vector<double> ReadColumn(const std::filesystem::path& csv, const std::string& name) {
  std::ifstream in(csv);
  std::string line, cell;
  std::vector<double> values;
  size_t wanted = 0;
  bool found = false;
  if (!std::getline(in, line)) return values;
  std::istringstream header(line);
  for (size_t k = 0; std::getline(header, cell, ','); ++k) {
    if (cell == name) wanted = k, found = true;
  }
  while (found && std::getline(in, line)) {
    std::istringstream cells(line);
    size_t k = 0;
    while (k <= wanted && std::getline(cells, cell, ',')) ++k;
    if (k == wanted + 1) values.push_back(std::strtod(cell.c_str(), nullptr));
  }
  return values;
}

}  // namespace

LossVerdict LossWatch::Judge(double loss) {
  if (!std::isfinite(loss)) return LossVerdict::kJumped;
  const double log_loss = std::log(std::max(loss, kLeastLoss));
  if (logs_.size() >= options_.least) {
    const double level = Median({logs_.begin(), logs_.end()});
    std::vector<double> away;
    for (const double x : logs_) away.push_back(std::abs(x - level));
    const double deviation = kNormalPerMad * Median(away), above = log_loss - level;
    const bool far = above > options_.deviations * deviation;
    const bool up = above > std::log(options_.sure_factor);
    up_ = up ? up_ + 1 : 0;
    suspicious_ = far && above > std::log(options_.least_factor) ? suspicious_ + 1 : 0;
    if ((up && far) || up_ >= options_.scatter_patience || suspicious_ >= options_.patience) {
      return LossVerdict::kJumped;
    }
    if (up || suspicious_ > 0) return LossVerdict::kSuspicious;
  }
  Keep(log_loss);
  return LossVerdict::kCalm;
}

void LossWatch::Remember(const std::filesystem::path& log_csv) {
  const std::vector<double> maps = ReadColumn(log_csv, "map");
  const std::vector<double> renderings = ReadColumn(log_csv, "render");
  for (size_t i = 0; i < std::min(maps.size(), renderings.size()); ++i) {
    const double loss = maps[i] + renderings[i];
    if (std::isfinite(loss)) Keep(std::log(std::max(loss, kLeastLoss)));
  }
}

void LossWatch::Keep(double log_loss) {
  logs_.push_back(log_loss);
  if (logs_.size() > options_.window) logs_.pop_front();
}

}  // namespace glint
