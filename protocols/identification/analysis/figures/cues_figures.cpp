#include "analysis/report/figures/style.hpp"
#include "protocols/identification/analysis/figures/figures.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {

namespace {

/// Adds participants' accuracies as dots.
void add_accuracies(Rows& rows, double at, std::vector<double> accuracy) {
  for (double& one : accuracy) one *= 100.0;
  std::sort(accuracy.begin(), accuracy.end());
  add_dots(rows, at - 0.17, 0.22, accuracy);
}

void add_mean(Rows& rows, double at, const MeanEstimate& mean) {
  if (mean.mean) add_bar(rows, at + 0.12, *mean.mean, mean.known_interval(), 100.0);
}

std::string alt_of_cues(const MethodCues& method) {
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
  Rows dots;
  Rows observers;
  Rows humans;
  for (std::size_t i = 0; i < method.observers.size(); ++i) {
    add_accuracies(dots, static_cast<double>(i + 1), method.observers[i].accuracy);
    add_mean(observers, static_cast<double>(i + 1), method.observers[i].mean);
  }
  const auto last = static_cast<double>(method.observers.size() + 1);
  add_accuracies(dots, last, method.human_accuracy);
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

/// The most grey values along the texture's longer side. More would be too fine for print and would
/// make the script large.
constexpr int kMaxPixels = 250;
constexpr double kPicture_cm = 10.0;
/// A palette that runs from dark to bright in grey as well, and whose colours differ from the
/// texture's grey (after Okabe and Ito).
constexpr const char* kForcePalette =
    "set palette defined (0 '#0072b2', 0.5 '#e69f00', 1 '#fff200')\n";

/// Every n-th grey value of the texture.
std::string texture_data(const PathTexture& texture) {
  const GreyImage& grey = texture.grey;
  const int step = (std::max(grey.width(), grey.height()) + kMaxPixels - 1) / kMaxPixels;
  std::string data = "$texture << EOD\n";
  for (int y = 0; y < grey.height(); y += step) {
    for (int x = 0; x < grey.width(); x += step) {
      // Brighter values let the path stand out.
      data += fmt::format("{} ", 128 + grey.at(y, x) / 2);
    }
    data += '\n';
  }
  return data + "EOD\n";
}

std::string texture_plot(const PathTexture& texture) {
  const GreyImage& grey = texture.grey;
  const int step = (std::max(grey.width(), grey.height()) + kMaxPixels - 1) / kMaxPixels;
  const int columns = (grey.width() + step - 1) / step;
  const int rows = (grey.height() + step - 1) / step;
  const double x_mm = texture.geometry.width_mm() / columns;
  const double y_mm = texture.geometry.height_mm() / rows;
  return fmt::format(
      "$texture matrix using (($1 + 0.5) * {:.6g}):(($2 + 0.5) * {:.6g}):3:3:3 with rgbimage "
      "notitle, ",
      x_mm, y_mm);
}

/// The parts of the path in contact. An empty line marks where the hand left the plane.
std::string path_data(const std::vector<PathPoint>& points) {
  std::string data = "$path << EOD\n";
  bool touching = false;
  for (const PathPoint& point : points) {
    if (point.in_contact) {
      data += fmt::format("{:.4g} {:.4g} {:.3g}\n", point.position_mm.x, point.position_mm.y,
                          point.tangential_rms_n);
    } else if (touching) {
      data += '\n';
    }
    touching = point.in_contact;
  }
  return data + "EOD\n";
}

double strongest(const std::vector<PathPoint>& points) {
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

std::string axes(const PlaneGeometry& geometry, double force_n) {
  return std::string(kForcePalette) +
         fmt::format(
             "set border 15\nunset grid\nset xrange [0:{}]\nset yrange [{}:0]\nset xlabel 'mm' "
             "offset 0, 0.4\nset ylabel 'mm'\nset cbrange [0:{:.3g}]\nset cblabel 'tangential "
             "force, N'\nset format cb '%g'\n",
             geometry.width_mm(), geometry.height_mm(), force_n > 0.0 ? force_n : 1.0);
}

std::string caption_of(const ExplorationPath& path) {
  const std::string who =
      path.participant.empty()
          ? "a trial of one participant"
          : fmt::format("by {}, session {}, trial {}", path.participant, path.session, path.trial);
  std::string caption = fmt::format(
      "exploration of {} ({}), {}. Colour is the tangential force, rms "
      "until "
      "the next point; the circle is first contact; where the hand was off the plane nothing is "
      "drawn.",
      path.class_label, path.method, who);
  if (!path.texture.grey.empty())
    caption += " Beneath it, brightened: " + path.texture.source + ".";
  return stamped(path.simulated, caption);
}

}  // namespace

std::optional<Figure> cues_figure(const CueReport& cues) {
  std::vector<const MethodCues*> shown;
  for (const MethodCues& method : cues.methods) {
    if (!method.observers.empty()) shown.push_back(&method);
  }
  if (shown.empty()) return {};
  // These names are short enough to be horizontal below half a sheet.
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
  Figure figure = figure_on(panels.sheet(), "ideal-observers",
                            "Accuracy of ideal observers that feel what the participants felt, "
                            "beside the participants', with 95 % intervals:",
                            "cues");
  figure.script = sheet_head(panels.sheet()) + "set multiplot\n";
  for (std::size_t i = 0; i < shown.size(); ++i) {
    figure.script += panels.begin(i, shown[i]->method) + below.script();
    if (i == 0) figure.script += legend.script();
    figure.script += panel_script(cues, *shown[i], i);
    figure.alt += alt_of_cues(*shown[i]);
  }
  figure.script += "unset multiplot\n";
  figure.caption = stamped(
      cues.simulated,
      "what was there to feel, and what participants made of it. Ideal observers judge each "
      "participant's own traces by force strength alone (rms), by the spectrum's shape alone, or "
      "by everything felt; means with 95 % t intervals over participants.");
  return figure;
}

Figure path_figure(const ExplorationPath& path) {
  const PlaneGeometry& geometry = path.texture.geometry;
  const double longer_mm = std::max({geometry.width_mm(), geometry.height_mm(), 1e-6});
  const double width_cm = kPicture_cm * std::max(geometry.width_mm() / longer_mm, 0.2);
  const double height_cm = kPicture_cm * std::max(geometry.height_mm() / longer_mm, 0.2);
  const Margins margins{1.7, 2.6, 0.8, 1.25};
  const Sheet sheet{width_cm + margins.left_cm + margins.right_cm,
                    height_cm + margins.top_cm + margins.bottom_cm, path.simulated};
  const double force_n = strongest(path.points);
  const PathPoint* start = first_contact(path.points);

  Figure figure = figure_on(sheet, fmt::format("exploration-{}-{}", path.session, path.trial), {},
                            kExplorations);
  figure.caption = caption_of(path);
  figure.alt = fmt::format(
      "Path of the hand over {} in {:.1f} s; strongest tangential force {:.2f} N; answered {}.",
      path.class_label, path.duration_s, force_n, path.answered_right ? "right" : "wrong");
  const bool picture = !path.texture.grey.empty();
  if (picture) figure.script += texture_data(path.texture);
  figure.script += path_data(path.points) + sheet_head(sheet) + panel_at(sheet, margins) +
                   axes(geometry, force_n) + "plot " +
                   (picture ? texture_plot(path.texture) : std::string());
  if (start == nullptr) {
    figure.script += "NaN notitle\n";
    return figure;
  }
  // A dark edge separates the path from the texture, in grey as well.
  figure.script += fmt::format(
      "$path using 1:2 with lines lw 2.6 lc rgb '{0}' notitle, $path using 1:2:3 with lines lw 1.5 "
      "lc palette notitle, '+' using ({1:.4g}):({2:.4g}) every ::0::0 with points pt 6 ps 1.1 lw 2 "
      "lc rgb '{0}' notitle\n",
      kInk, start->position_mm.x, start->position_mm.y);
  return figure;
}

}  // namespace touchtrial::analysis::identification
