#include "analysis/sheet/sheet_rows.hpp"

#include <functional>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

struct Figure {
  const char* name;
  const char* unit;
  std::function<std::string(const SheetCard&)> value;
};

std::string three_digits(double number) {
  return fmt::format("{:.3g}", number);
}
std::string per_cent(double share) {
  return fmt::format("{:.1f}", 100 * share);
}

std::string entropies(const SheetCard& card) {
  return fmt::format("{:.2f} / {:.2f}", card.picture_entropy, card.texture_entropy);
}

/// The gains of the study's model: of height, or of forces.
std::string gains(const SheetCard& card) {
  constexpr double kMicrometres = 1000;
  if (card.gains.height_mm > 0.0) {
    return three_digits(kMicrometres * card.gains.height_mm) + " um of height";
  }
  return three_digits(1000 * card.gains.tangential_n) + " / " +
         three_digits(1000 * card.gains.normal_n) + " mN";
}

std::string arrow(const SheetCard& card) {
  return fmt::format("{:.2g}", card.arrow_n);
}

const std::vector<Figure>& figures() {
  static const std::vector<Figure> all = {
      {"lateral force, rms", "N",
       [](const SheetCard& c) { return three_digits(c.statistics.tangential_rms_n); }},
      {"lateral force, 99.9th percentile", "N",
       [](const SheetCard& c) { return three_digits(c.statistics.tangential_p999_n); }},
      {"normal force, rms", "N",
       [](const SheetCard& c) { return three_digits(c.statistics.normal_rms_n); }},
      {"stiffness, 99th percentile", "N/mm",
       [](const SheetCard& c) { return three_digits(c.statistics.stiffness_p99_n_per_mm); }},
      {"renderable, 1 mm and longer", "% of power",
       [](const SheetCard& c) { return per_cent(1 - c.statistics.share_below_1_mm); }},
      {"up to 250 Hz at 100 mm/s", "% of power",
       [](const SheetCard& c) { return per_cent(1 - c.statistics.share_above_250_hz[1]); }},
      {"entropy, picture / texture", "nats", entropies},
      {"gains of a grey level", "", gains},
      {"an arrow of one pixel", "N", arrow}};
  return all;
}

}  // namespace

std::vector<SheetRow> figure_rows(const std::vector<SheetCard>& line, const std::string& level_of) {
  std::vector<SheetRow> rows;
  for (const Figure& figure : figures()) {
    rows.push_back({figure.name, figure.unit, {}});
    for (const SheetCard& card : line) rows.back().values.push_back(figure.value(card));
  }
  if (!line.empty() && !line.front().level.empty()) {
    rows.push_back({"level re threshold, " + level_of, "", {}});
    for (const SheetCard& card : line) rows.back().values.push_back(card.level);
  }
  return rows;
}

std::string title_of(const SheetCard& card) {
  return card.exemplar.empty() ? card.label : card.label + ", " + card.exemplar;
}

std::string size_of(const SheetCard& card) {
  return fmt::format("{:g} x {:g} mm", card.geometry.width_mm(), card.geometry.height_mm());
}

std::string patch_of(const SheetCard& card) {
  const double pitch_mm = card.geometry.pitch_mm;
  return fmt::format("{:g} x {:g} mm", card.patch.width * pitch_mm, card.patch.height * pitch_mm);
}

std::string heading_of(const StimulusSheet& sheet) {
  return "Stimuli of the study " + sheet.study + (sheet.simulated ? ", simulated" : "");
}

}  // namespace touchtrial::analysis
