#include "analysis/paper/published.hpp"
#include "analysis/report/figures/style.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

constexpr double kSpread = 0.6;  ///< width of the marks of one class, in widths of a class
/// More means need the page's whole width.
constexpr std::size_t kMaxMeansInColumn = 12;

double offset_of(std::size_t number, std::size_t count) {
  if (count < 2) return 0.0;
  return kSpread * (static_cast<double>(number) / static_cast<double>(count - 1) - 0.5);
}

/// An accuracy with its interval, over participants or as if trials were independent.
struct DrawnAccuracy {
  double share = 0.0;
  Interval interval;
};

std::optional<DrawnAccuracy> drawn_accuracy(const ClassAccuracy& accuracy) {
  const std::optional<double> share = accuracy.accuracy.share();
  if (!share) return std::nullopt;
  if (!accuracy.has_interval_over_participants()) return DrawnAccuracy{*share, accuracy.wilson};
  return DrawnAccuracy{*accuracy.mean.mean, accuracy.mean.interval};
}

/// The name of the intervals in captions and legends.
std::string interval_name(const StudyReport& report) {
  bool has_participant_intervals = false;
  bool has_trial_intervals = false;
  for (const MethodReport& method : report.methods) {
    for (const ClassAccuracy& accuracy : method.accuracy) {
      (accuracy.has_interval_over_participants() ? has_participant_intervals
                                                 : has_trial_intervals) = true;
    }
  }
  if (!has_participant_intervals) return "Wilson interval (trials as if independent)";
  return has_trial_intervals
             ? "t interval over participants (Wilson interval of trials if they do not differ)"
             : "t interval over participants";
}

Layer class_layer(const StudyReport& report, std::size_t number) {
  Layer layer{.kind = LayerKind::interval,
              .name = report.methods[number].method,
              .colour = series_colour(number),
              .glyph = series_glyph(number)};
  const std::vector<ClassAccuracy>& accuracy = report.methods[number].accuracy;
  for (std::size_t i = 0; i < accuracy.size(); ++i) {
    const std::optional<DrawnAccuracy> drawn = drawn_accuracy(accuracy[i]);
    if (!drawn) continue;
    layer.rows.push_back(bar(static_cast<double>(i + 1) + offset_of(number, report.methods.size()),
                             drawn->share, drawn->interval, 100.0));
    layer.rows.back().text = report.classes[i];
  }
  return layer;
}

std::string alt_of_methods(const StudyReport& report) {
  std::string alt = "Accuracy by class and method, with 95% " + interval_name(report) + ".";
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const MethodReport& method = report.methods[i];
    alt += fmt::format(" {}:", method.method);
    for (std::size_t k = 0; k < method.accuracy.size() && k < report.classes.size(); ++k) {
      const auto drawn = drawn_accuracy(method.accuracy[k]);
      if (!drawn) continue;
      alt += fmt::format(" {} {};", report.classes[k],
                         share_with_interval(drawn->share, drawn->interval));
    }
  }
  return alt;
}

/// The name of an image in Fig. 6 of the paper.
std::string paper_image(std::size_t i) {
  return fmt::format("image {}", i + 1);
}

/// The label in lower case, with spaces instead of hyphens and underscores.
std::string plain_name(std::string_view label) {
  std::string plain;
  for (const char c : label) {
    const auto byte = static_cast<unsigned char>(c);
    plain += c == '-' || c == '_' ? ' ' : static_cast<char>(std::tolower(byte));
  }
  return plain;
}

/// The marks of the paper's values: beside the class with the image's name, otherwise in a separate
/// column.
std::vector<Datum> paper_rows(std::span<const std::string> classes) {
  std::vector<Datum> rows;
  const auto column = static_cast<double>(classes.size()) + 1.0;
  for (std::size_t i = 0; i < kPublishedPercents.size(); ++i) {
    const auto found = std::find_if(classes.begin(), classes.end(), [i](const std::string& label) {
      return plain_name(label) == paper_image(i);
    });
    const double x = found == classes.end() ? column + 0.15 * (static_cast<double>(i) - 2.0)
                                            : static_cast<double>(found - classes.begin()) + 1.25;
    rows.push_back(
        {.x = x, .y = static_cast<double>(kPublishedPercents[i]), .text = paper_image(i)});
  }
  return rows;
}

std::string alt_of_accuracy(const StudyReport& report) {
  std::string alt = "Accuracy by class, with 95% " + interval_name(report) + ":";
  const MethodReport& method = report.methods.front();
  for (std::size_t i = 0; i < method.accuracy.size(); ++i) {
    const ClassAccuracy& accuracy = method.accuracy[i];
    const auto drawn = drawn_accuracy(accuracy);
    if (!drawn) continue;
    alt += fmt::format(" {} {}, {} of {};", report.classes[i],
                       share_with_interval(drawn->share, drawn->interval),
                       accuracy.accuracy.correct, accuracy.accuracy.n);
  }
  return alt + fmt::format(" chance {:.1f}%.", 100.0 / static_cast<double>(report.classes.size()));
}

}  // namespace

std::optional<Figure> methods_figure(const StudyReport& report) {
  const bool has_trials = std::any_of(report.methods.begin(), report.methods.end(),
                                      [](const MethodReport& m) { return m.overall.n > 0; });
  if (report.methods.size() < 2 || !has_trials) return {};
  const std::size_t means = report.methods.size() * report.classes.size();
  Figure figure = empty_figure("methods", "methods-compared", report.simulated,
                               means > kMaxMeansInColumn ? kPage_cm : kColumn_cm);
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size()))};
  put_label_outside(panel);
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    panel.layers.push_back(class_layer(report, i));
    panel.layers.back().in_key = true;
  }
  figure.panels = {std::move(panel)};
  figure.alt = alt_of_methods(report);
  figure.caption =
      stamped(report.simulated,
              "accuracy by presented class and method with its 95% " + interval_name(report) + ".");
  return figure;
}

std::optional<Figure> accuracy_figure(const StudyReport& report, bool paper_values) {
  if (report.methods.size() != 1) return {};
  Layer accuracy = class_layer(report, 0);
  if (accuracy.rows.empty()) return {};
  Figure figure = empty_figure("accuracy-by-class", "accuracy", report.simulated,
                               report.classes.size() > kMaxMeansInColumn ? kPage_cm : kColumn_cm);
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size()))};
  put_label_outside(panel);
  for (const Datum& row : accuracy.rows) {
    panel.layers.push_back(
        direct_label(row.x, row.y, fmt::format("{:.0f}", row.y), std::string(kInk)));
  }
  panel.layers.push_back(std::move(accuracy));
  if (paper_values) {
    Layer paper{.name = "paper (other images, other device)",
                .rows = paper_rows(report.classes),
                .colour = series_colour(1),
                .size = 1.6,
                .glyph = Glyph::ring,
                .in_key = true};
    const bool is_separate = std::ranges::any_of(paper.rows, [&](const Datum& row) {
      return row.x > static_cast<double>(report.classes.size()) + 0.5;
    });
    if (is_separate) panel.x.names.emplace_back("(paper)");
    panel.layers.push_back(std::move(paper));
  }
  figure.panels = {std::move(panel)};
  figure.alt = alt_of_accuracy(report);
  figure.caption = stamped(report.simulated, "accuracy by presented class with its 95% " +
                                                 interval_name(report) +
                                                 ". Trials without a response are wrong.");
  if (paper_values) {
    figure.caption +=
        " Open marks: published accuracies of five other images, felt on another device.";
  }
  return figure;
}

}  // namespace touchtrial::analysis::identification
