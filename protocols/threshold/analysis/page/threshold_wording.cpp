#include "analysis/report/page/wording.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;
using study::threshold::Along;
using study::threshold::Task;
using study::threshold::ThresholdOptions;

constexpr const char* kOpenEnd = "open";

std::string end_text(const std::optional<double>& end, int decimals) {
  return end ? plain_figure(end, decimals) : kOpenEnd;
}

std::string interval_text(const std::optional<double>& low, const std::optional<double>& high,
                          int decimals) {
  if (!low && !high) return "";
  return " [" + end_text(low, decimals) + ", " + end_text(high, decimals) + "]";
}

std::optional<double> hundredfold(const std::optional<double>& share) {
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

}  // namespace

std::string threshold_text(const procedures::Threshold& threshold,
                           const std::vector<double>& levels) {
  if (levels.empty()) return kNoFigure;
  if (threshold.censored == Censored::below) return "below " + plain_figure(levels.front(), 1);
  if (threshold.censored == Censored::above) return "above " + plain_figure(levels.back(), 1);
  if (!threshold.level) return kNoFigure;
  return plain_figure(threshold.level, 1) + interval_text(threshold.low, threshold.high, 1);
}

std::string quantity_text(const Quantity& quantity, const ThresholdOptions& options) {
  if (!quantity.value) return kNoFigure;
  if (options.along == Along::order) {
    return plain_figure(quantity.value, 3) + interval_text(quantity.low, quantity.high, 3);
  }
  return share_figure(quantity.value) +
         interval_text(hundredfold(quantity.low), hundredfold(quantity.high), 1);
}

std::string quantity_name(const ThresholdOptions& options) {
  if (options.task == Task::detection) return "";
  switch (options.along) {
    case Along::gain:
      return "Weber fraction";
    case Along::pitch:
      return "Weber fraction of the pitch";
    case Along::order:
      return "change of order";
    case Along::blend:
      return "share of the second texture";
  }
  return "";
}

}  // namespace touchtrial::analysis::threshold
