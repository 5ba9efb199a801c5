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
                        "Numbers after ± are half-widths of intervals of about 95 %.",
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
      // At the limit of stability, the damping is b = K (T/2 + delay), where T is one tick.
      const auto delay = certificate.mean_of(&device::AxisResult::delay_ms);
      const double damping = wall.oscillates_n_per_mm * (0.5 + (delay ? delay->value : 0.0));
      entries.emplace_back("first oscillating wall",
                           fmt::format("{:.2f} N/mm, where {}K (T/2 + delay) is {:.2f} N s/m",
                                       wall.oscillates_n_per_mm,
                                       delay ? "" : "(delay unknown, taken as 0) ", damping));
    }
  }
  if (certificate.warm) {
    entries.emplace_back("holding force at the start, and after twenty minutes",
                         fmt::format("{:.3f} N and {:.3f} N", certificate.warm->before_n,
                                     certificate.warm->after_n));
  }
  return figures;
}

/// Adds the figure with one panel per axis that plots `part`; nothing if no axis has data.
void add_curves(analysis::Section& section, analysis::Figure figure, analysis::Axis x,
                analysis::Axis y, const std::vector<device::AxisCurves>& curves,
                std::vector<std::pair<double, double>> device::AxisCurves::*part) {
  for (const device::AxisCurves& axis : curves) {
    if ((axis.*part).empty()) continue;
    analysis::Layer line{.kind = analysis::LayerKind::line,
                         .name = "axis " + std::string(device::name_of(axis.axis)),
                         .colour = analysis::series_colour(0)};
    for (const auto& [abscissa, ordinate] : axis.*part)
      line.rows.push_back({.x = abscissa, .y = ordinate});
    figure.panels.push_back({.title = line.name, .x = x, .y = y, .layers = {line}});
  }
  if (figure.panels.empty()) return;
  figure.panels_per_row = 3;
  analysis::Picture picture{figure.id, figure.caption, figure.alt, ""};
  try {
    picture.svg = analysis::draw_figure(figure, analysis::FigureFormat::svg);
  } catch (const Error& error) {
    spdlog::warn("{}", error.what());
  }
  section.blocks.emplace_back(std::move(picture));
}

analysis::Section results_of(const device::Certificate& certificate) {
  analysis::Section section{"results", "Results", {}};
  section.blocks.emplace_back(table_of_axes(certificate));
  section.blocks.emplace_back(device_figures(certificate));
  return section;
}

analysis::Section curves_of(const device::Acceptance& acceptance) {
  analysis::Section section{"curves", "Curves", {}};
  analysis::Figure friction = analysis::empty_figure("friction", "", false, analysis::kPage_cm);
  friction.caption =
      "Slow strokes: commanded force without the load over the handle's position. Half the height "
      "of a loop is friction.";
  friction.alt = "Commanded force over position, one loop per axis.";
  add_curves(section, std::move(friction), {.label = "position, mm"}, {.label = "force, N"},
             acceptance.curves, &device::AxisCurves::loop);
  analysis::Figure delay = analysis::empty_figure("delay", "", false, analysis::kPage_cm);
  delay.caption =
      "Bend of the path over the time since the push reversed. The peak is the delay; it serves "
      "soft arms, whose delay cannot be fitted together with mass and damping.";
  delay.alt = "Bend over delay, one line per axis.";
  add_curves(section, std::move(delay), {.label = "delay, ms"}, {.label = "bend, mm"},
             acceptance.curves, &device::AxisCurves::bend_by_delay);
  return section;
}

analysis::Section verdict_of(const device::Certificate& certificate) {
  analysis::Section section{"verdict", "Verdict", {}};
  const std::vector<std::string> failures = certificate.failures();
  section.blocks.emplace_back(analysis::CitedText{
      failures.empty() ? "Every requirement of a session with people was measured and is met."
                       : "Sessions with people cannot run on this device.",
      {},
      failures.empty() ? "Passed." : "Failed."});
  if (!failures.empty()) section.blocks.emplace_back(analysis::Warnings{failures, "Why"});
  if (!certificate.not_measured.empty()) {
    analysis::Warnings missing{{}, "Not measured"};
    for (const device::NotMeasured& gap : certificate.not_measured) {
      missing.sentences.push_back(gap.measurement + ": " + gap.reason);
    }
    section.blocks.emplace_back(std::move(missing));
  }
  return section;
}

/// The document without curves.
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
