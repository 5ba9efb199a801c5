#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/panels.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kMostDots = 100;  ///< participants drawn a column
constexpr double kGoldenSection = 0.618033988749895;

/// Participants' accuracies; of many, evenly spaced ones in order of accuracy.
void add_dots(std::vector<std::vector<double>>& rows, double at, std::vector<double> accuracy) {
  std::sort(accuracy.begin(), accuracy.end());
  const std::size_t shown = std::min(accuracy.size(), kMostDots);
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t which = shown < 2 ? 0 : k * (accuracy.size() - 1) / (shown - 1);
    const double aside = std::fmod(kGoldenSection * static_cast<double>(k), 1.0) - 0.5;
    rows.push_back({at - 0.17 + 0.22 * aside, 100.0 * accuracy[which]});
  }
}

void add_mean(std::vector<std::vector<double>>& rows, double at, const MeanEstimate& mean) {
  if (!mean.mean) return;
  const Interval bar = mean.known_interval().value_or(Interval{*mean.mean, *mean.mean});
  rows.push_back({at + 0.12, 100.0 * *mean.mean, 100.0 * bar.low, 100.0 * bar.high});
}

std::string alt_of(const MethodCues& method) {
  std::string alt = fmt::format(" {}:", method.method);
  for (const ObserverFigures& observer : method.observers) {
    if (!observer.mean.mean) continue;
    alt += fmt::format(" {} {};", title_of(observer.cue),
                       with_interval(*observer.mean.mean, observer.mean.known_interval()));
  }
  if (method.human_mean.mean) {
    alt += fmt::format(" participants {}.",
                       with_interval(*method.human_mean.mean, method.human_mean.known_interval()));
  }
  return alt;
}

std::string panel_script(const CueReport& cues, const MethodCues& method, std::size_t number) {
  std::vector<std::vector<double>> dots;
  std::vector<std::vector<double>> observers;
  std::vector<std::vector<double>> humans;
  for (std::size_t i = 0; i < method.observers.size(); ++i) {
    add_dots(dots, static_cast<double>(i + 1), method.observers[i].accuracy);
    add_mean(observers, static_cast<double>(i + 1), method.observers[i].mean);
  }
  const auto last = static_cast<double>(method.observers.size() + 1);
  add_dots(dots, last, method.human_accuracy);
  add_mean(humans, last, method.human_mean);
  const std::string observer_look = fmt::format("pt 5 ps 0.8 lw 1.6 lc rgb '{}'", series_colour(0));
  const std::string human_look = fmt::format("pt 7 ps 0.9 lw 1.6 lc rgb '{}'", series_colour(1));
  std::string script = data_block(fmt::format("dots{}", number), dots) +
                       data_block(fmt::format("observers{}", number), observers) +
                       data_block(fmt::format("humans{}", number), humans) +
                       accuracy_axis("correct, %") +
                       chance_line(static_cast<int>(std::max<std::size_t>(cues.classes.size(), 1)));
  script += fmt::format(
      "plot $dots{0} using 1:2 with points pt 7 ps 0.26 lc rgb '{1}' notitle, "
      "$observers{0} using 1:2:3:4 with yerrorbars {2} notitle",
      number, kFaint, observer_look);
  if (!humans.empty()) {
    script +=
        fmt::format(", $humans{} using 1:2:3:4 with yerrorbars {} notitle", number, human_look);
  }

  return script + "\nunset label\nunset arrow\n";
}

}  // namespace

std::optional<Figure> cues_figure(const CueReport& cues) {
  std::vector<const MethodCues*> shown;
  for (const MethodCues& method : cues.methods) {
    if (!method.observers.empty()) shown.push_back(&method);
  }
  if (shown.empty()) return {};
  // Short enough to stand level below half a sheet.
  const std::vector<std::string> columns = {"rms", "spectrum", "everything", "participants"};
  Margins around{1.5, 0.4, 0.6, 0.9};
  const NamesBelow below(columns, Panels(shown.size(), 2, 7.0, around, cues.simulated).axis_cm());
  around.bottom_cm = below.room_cm() + 0.3;
  const Panels panels(shown.size(), 2, 6.1 + around.bottom_cm, around, cues.simulated);
  const Legend legend(
      panels.sheet(), 1.5,
      std::vector<LegendEntry>{mark_entry(5, series_colour(0), "ideal observer"),
                               mark_entry(7, series_colour(1), "participants"),
                               mark_entry(7, kFaint, "each participant"),
                               chance_entry(static_cast<int>(cues.classes.size()))});
  Figure figure{
      .id = "ideal-observers",
      .caption = {},
      .alt =
          "Accuracy of ideal observers that "
          "feel what the participants felt, beside the participants', with 95 % intervals:",
      .script = sheet_head(panels.sheet()) + "set multiplot\n"};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    figure.script += panels.begin(i, shown[i]->method) + below.script();
    if (i == 0) figure.script += legend.script();
    figure.script += panel_script(cues, *shown[i], i);
    figure.alt += alt_of(*shown[i]);
  }
  figure.script += "unset multiplot\n";
  figure.width_cm = panels.sheet().width_cm;
  figure.height_cm = panels.sheet().height_cm;
  figure.caption = stamped(
      cues.simulated,
      "what was there to feel, and what participants made of it. Ideal observers judge each "
      "participant's own traces by force strength alone (rms), by the spectrum's shape alone, or "
      "by "
      "everything felt; means with 95 % t intervals over participants.");
  return figure;
}

}  // namespace touchtrial::analysis
