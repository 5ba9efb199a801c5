#include "app/commands/device_accept_page.hpp"

#include "analysis/report/figures/style.hpp"
#include "analysis/report/page/document.hpp"
#include "core/errors.hpp"
#include "core/utc.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

using analysis::Cell;

std::string number_cell(const std::optional<device::Measured>& measured, int digits,
                        double factor = 1.0) {
  if (!measured) return "-";
  return fmt::format("{:.{}f} ± {:.{}f}", factor * measured->value, digits,
                     factor * measured->error, digits);
}

std::string push_cell(const std::optional<device::PushResult>& push) {
  if (!push) return "-";
  if (!push->moved) return fmt::format("no motion at {:.1f} N", push->force_n);
  return fmt::format("{:+.1f} mm at {:.1f} N", push->along_mm, push->force_n);
}

analysis::Table table_of_axes(const device::Certificate& certificate) {
  analysis::Table table{"axes",
                        "Each axis of the device frame (x right, y up, z towards the person). "
                        "Numbers have the half-width of their interval of about 95 %.",
                        {{"axis", analysis::Align::left},
                         {"push along it", analysis::Align::right},
                         {"push against it", analysis::Align::right},
                         {"delivered, %", analysis::Align::right},
                         {"friction, N", analysis::Align::right},
                         {"mass, kg", analysis::Align::right},
                         {"damping, N s/m", analysis::Align::right},
                         {"delay, ms", analysis::Align::right}}};
  for (const device::AxisResult& axis : certificate.axes) {
    table.rows.push_back({Cell(std::string(device::name_of(axis.axis))), Cell(push_cell(axis.plus)),
                          Cell(push_cell(axis.minus)), Cell(number_cell(axis.scale(), 1, 100.0)),
                          Cell(number_cell(axis.friction_n, 3)), Cell(number_cell(axis.mass_kg, 3)),
                          Cell(number_cell(axis.viscous_n_s_per_m, 1)),
                          Cell(number_cell(axis.delay_ms, 1))});
  }
  return table;
}

analysis::Definitions device_figures(const device::Certificate& certificate) {
  analysis::Definitions figures;
  auto& entries = figures.entries;
  if (certificate.rest) {
    entries.emplace_back("noise and drift at rest",
                         fmt::format("{:.4f} mm and {:.3f} mm", certificate.rest->noise_mm,
                                     certificate.rest->drift_mm));
  }
  if (certificate.step_mm) {
    entries.emplace_back("encoder step", number_cell(certificate.step_mm, 4) + " mm");
  }
  if (certificate.wall) {
    const device::WallResult& wall = *certificate.wall;
    entries.emplace_back("stiffest stable wall", fmt::format("{:.2f} N/mm; the trials ended by {}",
                                                             wall.stable_n_per_mm, wall.ended));
    if (wall.oscillates_n_per_mm > 0.0) {
      // b = K (T/2 + delay) at the edge; T is one tick.
      const auto delay = certificate.mean_of(&device::AxisResult::delay_ms);
      const double damping = wall.oscillates_n_per_mm * (0.5 + (delay ? delay->value : 0.0));
      entries.emplace_back("first wall that swings",
                           fmt::format("{:.2f} N/mm, where {}K (T/2 + delay) is {:.2f} N s/m",
                                       wall.oscillates_n_per_mm,
                                       delay ? "" : "(delay unknown, taken as 0) ", damping));
    }
  }
  if (certificate.warm) {
    entries.emplace_back("load's force at first, and after twenty minutes",
                         fmt::format("{:.3f} N and {:.3f} N", certificate.warm->before_n,
                                     certificate.warm->after_n));
  }
  return figures;
}

struct PlotWords {
  std::string id;
  std::string caption;
  std::string alt;
  std::string x;
  std::string y;
};

/// A line of a plot.
struct PlotLine {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

std::vector<PlotLine> lines_of(const std::vector<device::AxisCurves>& curves,
                               std::vector<std::pair<double, double>> device::AxisCurves::*part) {
  std::vector<PlotLine> lines;
  for (const device::AxisCurves& one : curves) {
    lines.push_back({"axis " + std::string(device::name_of(one.axis)), one.*part});
  }
  return lines;
}

/// Lines of one kind; without any, a picture without an id.
/// \param more  of the plot's script, before the lines
analysis::Picture lines_picture(const PlotWords& words, const std::vector<PlotLine>& lines,
                                const std::string& more = "") {
  const analysis::Sheet sheet{16.0, 8.0, false};
  analysis::Margins margins;
  margins.left_cm = 1.7;
  margins.top_cm = 1.1;
  margins.bottom_cm = 1.25;
  std::string data;
  std::string plot;
  std::vector<analysis::LegendEntry> entries;
  std::size_t series = 0;
  for (const PlotLine& line : lines) {
    if (line.points.empty()) continue;
    std::vector<std::vector<double>> rows;
    for (const auto& [x, y] : line.points) rows.push_back({x, y});
    const std::string block = fmt::format("line_{}", series);
    data += analysis::data_block(block, rows);
    plot += fmt::format("{}${} using 1:2 with lines lw 1.5 lc rgb '{}' notitle",
                        series == 0 ? "plot " : ", ", block, analysis::series_colour(series));
    entries.push_back({analysis::LegendEntry::Kind::line,
                       std::string(analysis::series_colour(series)), 7, line.name});
    ++series;
  }
  if (series == 0) return {};
  constexpr double kLegendRowCm = 0.45;
  margins.top_cm += kLegendRowCm * static_cast<double>((series - 1) / 3);
  const analysis::Legend legend(sheet, margins.left_cm, entries);
  analysis::Figure figure = analysis::figure_on(sheet, words.id, words.alt);
  figure.caption = words.caption;
  figure.script =
      data + analysis::sheet_head(sheet) + analysis::panel_at(sheet, margins) +
      fmt::format("set xlabel '{}' offset 0, 0.4\nset ylabel '{}'\n", words.x, words.y) +
      legend.script() + more + plot + "\n";
  analysis::Picture picture{words.id, words.caption, words.alt, ""};
  try {
    picture.svg = analysis::drawn(figure, analysis::FigureFormat::svg);
  } catch (const Error& error) {
    spdlog::warn("{}", error.what());
  }
  return picture;
}

void add_lines(analysis::Section& section, analysis::Picture picture) {
  if (!picture.id.empty()) section.blocks.emplace_back(std::move(picture));
}

analysis::Section results_of(const device::Certificate& certificate) {
  analysis::Section section{"results", "Results", {}};
  section.blocks.emplace_back(table_of_axes(certificate));
  section.blocks.emplace_back(device_figures(certificate));
  return section;
}

analysis::Section curves_of(const device::Acceptance& acceptance) {
  analysis::Section section{"curves", "Curves", {}};
  add_lines(section, lines_picture({"friction",
                                    "Slow strokes: commanded force without the load over the "
                                    "handle's place. Half the height of a loop is friction.",
                                    "Commanded force over place, a loop for each axis.",
                                    "place, mm", "force, N"},
                                   lines_of(acceptance.curves, &device::AxisCurves::loop)));
  add_lines(section,
            lines_picture({"delay",
                           "How sharply the path bends at a time after the push turns "
                           "round. The highest point is the delay, where soft arms "
                           "keep the fit of mass and damping from telling it.",
                           "Bend over delay, a line for each axis.", "delay, ms", "bend, mm"},
                          lines_of(acceptance.curves, &device::AxisCurves::by_delay)));
  return section;
}

analysis::Section verdict_of(const device::Certificate& certificate) {
  analysis::Section section{"verdict", "Verdict", {}};
  const std::vector<std::string> failures = certificate.failures();
  section.blocks.emplace_back(analysis::Cited{
      failures.empty() ? "Every requirement of a session with people was measured and is met."
                       : "No session with people runs on this device.",
      {},
      failures.empty() ? "Passed." : "Failed."});
  if (!failures.empty()) section.blocks.emplace_back(analysis::Warnings{failures, "Why"});
  if (!certificate.not_measured.empty()) {
    analysis::Warnings missing{{}, "Not measured"};
    for (const device::NotMeasured& one : certificate.not_measured) {
      missing.sentences.push_back(one.what + ": " + one.why);
    }
    section.blocks.emplace_back(std::move(missing));
  }
  return section;
}

/// Without its curves.
analysis::Document document_of(const device::Certificate& certificate) {
  analysis::Document document;
  document.title = "Acceptance of " + certificate.driver +
                   (certificate.model.empty() ? "" : ", " + certificate.model);
  if (!certificate.emulated.empty()) {
    document.stamp = "REHEARSAL";
    document.banners.push_back("REHEARSAL on an emulated device (" + certificate.emulated +
                               "): tests the program, not a device.");
  }
  document.header.entries = {{"driver", certificate.driver},
                             {"model", certificate.model},
                             {"serial number", certificate.serial},
                             {"firmware", certificate.firmware},
                             {"made", utc_text(certificate.made.time_since_epoch())},
                             {"program", certificate.program}};
  document.about = "This certificate";
  document.sections = {verdict_of(certificate), results_of(certificate)};
  document.colophon = "The numbers are in the JSON file beside this page, which sessions read.";
  return document;
}

}  // namespace

std::string acceptance_page(const device::Acceptance& acceptance) {
  analysis::Document document = document_of(acceptance.certificate);
  if (analysis::Section curves = curves_of(acceptance); !curves.blocks.empty()) {
    document.sections.push_back(std::move(curves));
  }
  return analysis::page_html(document);
}

std::string acceptance_text(const device::Certificate& certificate, std::size_t width) {
  return analysis::document_text(document_of(certificate), width);
}

}  // namespace touchtrial::app
