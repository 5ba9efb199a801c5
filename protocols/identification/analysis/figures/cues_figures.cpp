#include "analysis/report/figures/style.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// Adds participants' accuracies as dots.
void add_accuracies(Layer& dots, double x, const std::vector<double>& accuracy,
                    const std::vector<std::string>& participants) {
  std::vector<ParticipantValue> values;
  for (std::size_t i = 0; i < accuracy.size(); ++i) {
    values.push_back({100.0 * accuracy[i], i < participants.size() ? participants[i] : ""});
  }
  swarm(dots.rows, x - 0.1, 0.55, 1.5, std::move(values));
}

void add_mean(Layer& means, double x, const MeanEstimate& mean) {
  if (mean.mean) {
    means.rows.push_back(bar(x + 0.28, *mean.mean, mean.known_interval(), 100.0));
  }
}

std::string alt_of_cues(const MethodCues& method) {
  std::string alt = fmt::format(" {}:", method.method);
  for (const ObserverFigures& observer : method.observers) {
    if (!observer.mean.mean) continue;
    alt += fmt::format(" {} {};", title_of(observer.cue),
                       share_with_interval(*observer.mean.mean, observer.mean.known_interval()));
  }
  if (method.human_mean.mean) {
    alt += fmt::format(
        " participants {}.",
        share_with_interval(*method.human_mean.mean, method.human_mean.known_interval()));
  }
  return alt;
}

Panel cues_panel(const CueReport& cues, const MethodCues& method) {
  Layer dots{.name = "each participant", .colour = std::string(kPale), .size = 0.7};
  Layer observers{.kind = LayerKind::interval,
                  .name = "ideal observers",
                  .colour = series_colour(0),
                  .size = 1.1,
                  .glyph = Glyph::square};
  Layer people{
      .kind = LayerKind::interval, .name = "participants", .colour = series_colour(1), .size = 1.1};
  Panel panel;
  panel.x = names_axis({"rms", "spectrum", "everything", "people"});
  double x = 1.0;
  for (const ObserverFigures& observer : method.observers) {
    add_accuracies(dots, x, observer.accuracy, method.participants);
    add_mean(observers, x, observer.mean);
    x += 1.0;
  }
  add_accuracies(dots, x, method.human_accuracy, method.participants);
  add_mean(people, x, method.human_mean);
  panel.y = percent_axis("correct, %");
  panel.layers = {chance_rule(static_cast<int>(cues.classes.size())), std::move(dots),
                  std::move(observers), std::move(people)};
  return panel;
}

/// The maximum along the texture's longer side. More would be too fine for print and make the
/// script large.
constexpr int kMaxPixels = 250;
constexpr double kWidth_cm = 9.5;
constexpr double kArrows = 14.0;  ///< along a path
/// Share of the plane's longer side; a shorter arrow would be hidden by its head.
constexpr double kMinArrowShare = 0.02;

/// Every n-th grey value of the texture, brightened so that the path is visible.
GreyImage backdrop(const GreyImage& grey) {
  const int step =
      std::max(1, (std::max(grey.width(), grey.height()) + kMaxPixels - 1) / kMaxPixels);
  GreyImage picture((grey.height() + step - 1) / step, (grey.width() + step - 1) / step);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      picture.at(y, x) = static_cast<std::uint8_t>(160 + grey.at(y * step, x * step) * 3 / 8);
    }
  }
  return picture;
}

/// The parts of the path in contact, numbered.
Layer path_layer(const std::vector<PathPoint>& points) {
  Layer layer{.kind = LayerKind::path, .name = "path, coloured by force in N"};
  int part = 0;
  bool touching = false;
  for (const PathPoint& point : points) {
    if (point.in_contact && !touching) ++part;
    touching = point.in_contact;
    if (!touching) continue;
    layer.rows.push_back({.x = point.position_mm.x,
                          .y = point.position_mm.y,
                          .value = point.tangential_rms_n,
                          .text = std::to_string(part)});
  }
  return layer;
}

/// Arrows in the direction of time, evenly along the path's rows.
Layer arrows_along(const Layer& path, double longer_mm) {
  Layer arrows{.kind = LayerKind::arrow, .name = "direction of time", .size = 1.0};
  const auto step = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(path.rows.size()) / kArrows));
  for (std::size_t i = step / 2; i < path.rows.size(); i += step) {
    const Datum& from = path.rows[i];
    for (std::size_t k = i + 1; k < path.rows.size() && path.rows[k].text == from.text; ++k) {
      const Datum& to = path.rows[k];
      if (std::hypot(to.x - from.x, to.y - from.y) < kMinArrowShare * longer_mm) continue;
      arrows.rows.push_back({.x = from.x, .y = from.y, .low = to.x, .high = to.y});
      break;
    }
  }
  return arrows;
}

double max_force_n(const std::vector<PathPoint>& points) {
  double force_n = 0.0;
  for (const PathPoint& point : points) {
    if (point.in_contact) force_n = std::max(force_n, point.tangential_rms_n);
  }
  return force_n;
}

const PathPoint* first_contact(const std::vector<PathPoint>& points) {
  const auto found = std::find_if(points.begin(), points.end(),
                                  [](const PathPoint& point) { return point.in_contact; });
  return found == points.end() ? nullptr : &*found;
}

std::string caption_of(const ExplorationPath& path) {
  const std::string trial =
      path.participant.empty()
          ? "a trial of one participant"
          : fmt::format("by {}, session {}, trial {}", path.participant, path.session, path.trial);
  std::string caption = fmt::format(
      "exploration of {} ({}), {}. Colour is the tangential force, rms until the next point; the "
      "circle is the first contact; arrows show the direction of time; only contact is drawn.",
      path.class_label, path.method, trial);
  if (!path.texture.grey.empty())
    caption += " Background, brightened: " + path.texture.source + ".";
  return stamped(path.simulated, caption);
}

}  // namespace

std::optional<Figure> cues_figure(const CueReport& cues) {
  Figure figure = empty_figure("ideal-observers", "cues", cues.simulated);
  figure.panels_per_row = 2;
  figure.alt =
      "Accuracy of ideal observers and of participants in the same trials, with 95% intervals:";
  for (const MethodCues& method : cues.methods) {
    if (method.observers.empty()) continue;
    figure.panels.push_back(cues_panel(cues, method));
    figure.panels.back().title = method.method;
    figure.alt += alt_of_cues(method);
  }
  if (figure.panels.empty()) return {};
  if (figure.panels.size() > 1) {
    figure.width_cm = kPage_cm;
  } else {
    figure.panels.front().title.clear();
  }
  figure.caption = stamped(
      cues.simulated,
      "available information, and participants' accuracy. Ideal observers (squares) judge each "
      "participant's traces by force strength only (rms), by the spectrum's shape only, or by "
      "everything felt; means with 95% t intervals over participants, and each participant.");
  return figure;
}

Figure path_figure(const ExplorationPath& path) {
  const PlaneGeometry& geometry = path.texture.geometry;
  const double longer_mm = std::max({geometry.width_mm(), geometry.height_mm(), 1e-6});
  Figure figure = empty_figure(fmt::format("exploration-{}-{}", path.session, path.trial),
                               kExplorations, path.simulated, kWidth_cm);
  figure.caption = caption_of(path);
  figure.alt = fmt::format(
      "Path of the hand over {} in {:.1f} s; strongest tangential force {:.2f} N; answered {}.",
      path.class_label, path.duration_s, max_force_n(path.points),
      path.answered_right ? "right" : "wrong");
  Panel panel;
  panel.x = {.label = "mm", .low = 0.0, .high = std::max(geometry.width_mm(), 1e-6)};
  panel.y = {
      .label = "mm", .low = 0.0, .high = std::max(geometry.height_mm(), 1e-6), .reversed = true};
  panel.aspect = std::clamp(geometry.height_mm() / std::max(geometry.width_mm(), 1e-6), 0.2, 5.0);
  panel.colour_scale = "tangential force, N";
  panel.scale_max = max_force_n(path.points);
  if (!path.texture.grey.empty()) {
    panel.layers.push_back(
        {.kind = LayerKind::picture,
         .name = "texture",
         .rows = {{.x = 0.0, .y = 0.0, .low = geometry.width_mm(), .high = geometry.height_mm()}},
         .grey = backdrop(path.texture.grey)});
  }
  panel.layers.push_back(path_layer(path.points));
  panel.layers.push_back(arrows_along(panel.layers.back(), longer_mm));
  if (const PathPoint* start = first_contact(path.points)) {
    panel.layers.push_back({.name = "first contact",
                            .rows = {{.x = start->position_mm.x, .y = start->position_mm.y}},
                            .size = 2.2,
                            .glyph = Glyph::ring});
  }
  figure.panels = {std::move(panel)};
  return figure;
}

}  // namespace touchtrial::analysis::identification
