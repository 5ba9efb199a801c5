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

constexpr double kSpread = 0.6;  ///< width of the methods of one class, in widths of a class
/// More means than these need the page's whole width.
constexpr std::size_t kMeansOfColumn = 12;

double aside(std::size_t number, std::size_t count) {
  if (count < 2) return 0.0;
  return kSpread * (static_cast<double>(number) / static_cast<double>(count - 1) - 0.5);
}

/// What is drawn of a class: over participants, or as if trials were independent.
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

/// What the intervals are, for captions and legends.
std::string interval_name(const StudyReport& report) {
  bool over_participants = false;
  bool of_trials = false;
  for (const MethodReport& method : report.methods) {
    for (const ClassAccuracy& one : method.accuracy) {
      (one.has_interval_over_participants() ? over_participants : of_trials) = true;
    }
  }
  if (!over_participants) return "Wilson interval (trials as if independent)";
  return of_trials ? "t interval over participants (Wilson, of trials, where they do not differ)"
                   : "t interval over participants";
}

Layer class_layer(const StudyReport& report, std::size_t number) {
  Layer layer{.kind = LayerKind::interval,
              .name = report.methods[number].method,
              .colour = series_colour(number),
              .glyph = series_glyph(number)};
  const std::vector<ClassAccuracy>& accuracy = report.methods[number].accuracy;
  for (std::size_t i = 0; i < accuracy.size(); ++i) {
    const std::optional<DrawnAccuracy> one = drawn_accuracy(accuracy[i]);
    if (!one) continue;
    layer.rows.push_back(bar(static_cast<double>(i + 1) + aside(number, report.methods.size()),
                             one->share, one->interval, 100.0));
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
      const auto at = drawn_accuracy(method.accuracy[k]);
      if (!at) continue;
      alt += fmt::format(" {} {};", report.classes[k], with_interval(at->share, at->interval));
    }
  }
  return alt;
}

/// The paper's name for an image of its Fig. 6.
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

/// The marks of the paper's values. A value stands beside the class that has its image's name, or
/// otherwise in a column of its own.
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
    const ClassAccuracy& at = method.accuracy[i];
    const auto drawn = drawn_accuracy(at);
    if (!drawn) continue;
    alt += fmt::format(" {} {}, {} of {};", report.classes[i],
                       with_interval(drawn->share, drawn->interval), at.accuracy.correct,
                       at.accuracy.n);
  }
  return alt + fmt::format(" chance {:.1f} %.", 100.0 / static_cast<double>(report.classes.size()));
}

}  // namespace

std::optional<Figure> methods_figure(const StudyReport& report) {
  const bool any = std::any_of(report.methods.begin(), report.methods.end(),
                               [](const MethodReport& m) { return m.overall.n > 0; });
  if (report.methods.size() < 2 || !any) return {};
  const std::size_t means = report.methods.size() * report.classes.size();
  Figure figure = figure_named("methods", "methods-compared", report.simulated,
                               means > kMeansOfColumn ? kPage_cm : kColumn_cm);
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size()))};
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
  Figure figure = figure_named("accuracy-by-class", "accuracy", report.simulated,
                               report.classes.size() > kMeansOfColumn ? kPage_cm : kColumn_cm);
  Panel panel;
  panel.x = names_axis(report.classes);
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(report.classes.size()))};
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
    const bool apart = std::ranges::any_of(paper.rows, [&](const Datum& row) {
      return row.x > static_cast<double>(report.classes.size()) + 0.5;
    });
    if (apart) panel.x.names.emplace_back("(paper)");
    panel.layers.push_back(std::move(paper));
  }
  figure.panels = {std::move(panel)};
  figure.alt = alt_of_accuracy(report);
  figure.caption = stamped(report.simulated, "accuracy by presented class with its 95% " +
                                                 interval_name(report) +
                                                 ". Trials without a response are wrong.");
  if (paper_values) {
    figure.caption +=
        " Open marks: accuracies published for five images, which are other images felt on another "
        "device.";
  }
  return figure;
}

}  // namespace touchtrial::analysis::identification
