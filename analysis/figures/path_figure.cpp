#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Grey values of the texture that are drawn along its longer side: finer ones are below what print
/// shows, and make the script large.
constexpr int kMostPixels = 250;
constexpr double kPicture_cm = 10.0;
/// Dark to bright in grey too, and apart from the texture's grey by colour (after Okabe and Ito).
constexpr const char* kForcePalette =
    "set palette defined (0 '#0072b2', 0.5 '#e69f00', 1 '#fff200')\n";

/// Every n-th grey value with its place in millimetres; nothing without a picture.
std::string texture_data(const PathTexture& texture) {
  const GreyImage& grey = texture.grey;
  const int step = (std::max(grey.width(), grey.height()) + kMostPixels - 1) / kMostPixels;
  std::string data = "$texture << EOD\n";
  for (int y = 0; y < grey.height(); y += step) {
    for (int x = 0; x < grey.width(); x += step) {
      // Brighter than it is: the path has to stand out from it.
      data += fmt::format("{} ", 128 + grey.at(y, x) / 2);
    }
    data += '\n';
  }
  return data + "EOD\n";
}

std::string texture_plot(const PathTexture& texture) {
  const GreyImage& grey = texture.grey;
  const int step = (std::max(grey.width(), grey.height()) + kMostPixels - 1) / kMostPixels;
  const int columns = (grey.width() + step - 1) / step;
  const int rows = (grey.height() + step - 1) / step;
  const double x_mm = texture.geometry.width_mm() / columns;
  const double y_mm = texture.geometry.height_mm() / rows;
  return fmt::format(
      "$texture matrix using (($1 + 0.5) * {:.6g}):(($2 + 0.5) * {:.6g}):3:3:3 with rgbimage "
      "notitle, ",
      x_mm, y_mm);
}

/// Pieces of the path in contact; an empty line where the hand was off the plane.
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
  std::string caption = fmt::format(
      "exploration of {} ({}) by {}, session {}, trial {}. Colour is the tangential force, rms "
      "until "
      "the next point; the circle is first contact; where the hand was off the plane nothing is "
      "drawn.",
      path.class_label, path.method, path.participant, path.session, path.trial);
  if (!path.texture.grey.empty())
    caption += " Beneath it, brightened: " + path.texture.source + ".";
  return stamped(path.simulated, caption);
}

}  // namespace

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

  Figure figure{.id = fmt::format("exploration-{}-{}", path.session, path.trial),
                .caption = caption_of(path),
                .alt = {},
                .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
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
  // A dark edge around the path keeps its colours apart from the texture in grey as well.
  figure.script += fmt::format(
      "$path using 1:2 with lines lw 2.6 lc rgb '{0}' notitle, $path using 1:2:3 with lines lw 1.5 "
      "lc palette notitle, '+' using ({1:.4g}):({2:.4g}) every ::0::0 with points pt 6 ps 1.1 lw 2 "
      "lc rgb '{0}' notitle\n",
      kInk, start->position_mm.x, start->position_mm.y);
  return figure;
}

}  // namespace touchtrial::analysis
