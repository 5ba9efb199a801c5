#include "analysis/figures/panels.hpp"

#include "analysis/text_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {

Panels::Panels(std::size_t count, std::size_t across, double height_cm, const Margins& around,
               bool simulated)
    : count_(count),
      across_(std::min(count, across)),
      height_cm_(height_cm),
      around_(around),
      sheet_{16.0, kLegend_cm, simulated} {
  const std::size_t rows = (count_ + across_ - 1) / across_;
  sheet_.height_cm += height_cm_ * static_cast<double>(rows);
}

double Panels::axis_cm() const noexcept {
  return sheet_.width_cm / static_cast<double>(across_) - around_.left_cm - around_.right_cm;
}

std::string Panels::begin(std::size_t panel, const std::string& title) const {
  const double share_cm = sheet_.width_cm / static_cast<double>(across_);
  const double left_cm = share_cm * static_cast<double>(panel % across_);
  const double top_cm = kLegend_cm + height_cm_ * static_cast<double>(panel / across_);
  const Margins margins{
      left_cm + around_.left_cm, sheet_.width_cm - left_cm - share_cm + around_.right_cm,
      top_cm + around_.top_cm, sheet_.height_cm - top_cm - height_cm_ + around_.bottom_cm};
  std::string script = panel_at(sheet_, margins);
  if (count_ > 1) {
    const auto columns = static_cast<std::size_t>(std::max(axis_cm() / 0.17, 8.0));
    script += text_at(fitted(title, columns), "graph 0, graph 1 left offset 0.2, 0.6");
  }
  return script;
}

}  // namespace touchtrial::analysis
