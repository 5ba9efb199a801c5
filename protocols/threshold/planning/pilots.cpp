#include "protocols/threshold/planning/pilots.hpp"

#include "core/errors.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning::threshold {
namespace {

using nlohmann::json;

constexpr std::size_t kMinPilots = 3;
/// Right answers at the threshold that levels count from (d' = 1.62) among two and three intervals.
constexpr double kRightOfTwo = 0.8744;
constexpr double kRightOfThree = 0.794;

/// The threshold of a track, at the share of right answers that levels count from, dB.
double threshold_db(const json& track, double guess) {
  const json& found = track.at("posterior");
  const double right = guess > 0.4 ? kRightOfTwo : kRightOfThree;
  // Along the track's Weibull function.
  const double more = std::log10(-std::log((1.0 - right) / (1.0 - guess)));
  return found.at("threshold").get<double>() + 20.0 * more / found.at("slope").get<double>();
}

}  // namespace

std::optional<std::vector<std::pair<std::string, double>>> pilot_means(const std::string& text,
                                                                       const std::string& place) {
  const json report = json::parse(text);
  if (report.value("task", "") != "detection" || report.value("along", "") != "gain" ||
      report.value("question", "") != "which-interval") {
    return std::nullopt;
  }
  std::vector<std::pair<std::string, double>> means;
  for (const json& standard : report.at("standards")) {
    double sum = 0.0;
    std::size_t found = 0;
    std::size_t censored = 0;
    for (const json& track : report.at("tracks")) {
      if (track.at("standard") != standard.at("standard")) continue;
      if (track.at("posterior").at("threshold").is_null()) {
        ++censored;
        continue;
      }
      sum += threshold_db(track, report.at("guess").get<double>());
      ++found;
    }
    if (found < kMinPilots || censored > found) {
      throw StudyError(one_line(fmt::format(
          "{}: has {} thresholds of {} and {} that lie beyond its levels; it "
          "needs {} or more, and fewer beyond",
          place, found, standard.at("standard").get<std::string>(), censored, kMinPilots)));
    }
    means.emplace_back(standard.at("class").get<std::string>(), sum / static_cast<double>(found));
  }
  if (means.empty()) throw StudyError(one_line(place + ": has no threshold yet"));
  return means;
}

}  // namespace touchtrial::planning::threshold
