#include "analysis/figures/figure_kinds.hpp"
#include "analysis/figures/style.hpp"
#include "analysis/text_table.hpp"

#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr double kLine_cm = 0.42;
constexpr double kBoxLeft_cm = 0.5;
constexpr double kBoxWidth_cm = 5.0;
constexpr double kSideLeft_cm = 7.0;
constexpr double kSideWidth_cm = 8.5;
constexpr double kWidth_cm = 16.0;
constexpr std::size_t kSideColumns = 46;
constexpr std::size_t kMostReasons = 8;

void add_line(std::vector<std::string>& lines, int count, const std::string& what) {
  if (count > 0) lines.push_back(fmt::format("{} {}", count, what));
}

/// Each reason once, with how many had it.
void add_reasons(std::vector<std::string>& lines, const ParticipantFlow& flow) {
  std::map<std::string, int> counts;
  for (const std::string& reason : flow.exclusion_reasons) ++counts[reason];
  std::size_t shown = 0;
  for (const auto& [reason, count] : counts) {
    if (++shown > kMostReasons) {
      lines.push_back(fmt::format("    and {} further reasons", counts.size() - kMostReasons));
      return;
    }
    lines.push_back(
        "    " + fitted(fmt::format("{}: {}", count, reason.empty() ? "no reason given" : reason),
                        kSideColumns));
  }
}

std::vector<std::string> left_out(const ParticipantFlow& flow) {
  std::vector<std::string> lines;
  add_line(lines, flow.withdrawn, "withdrawn");
  add_line(lines, flow.replaced, "replaced by somebody else");
  add_line(lines, flow.stopped, "stopped before the end");
  add_line(lines, flow.open, "session not ended");
  add_line(lines, flow.other_kind, "of another kind (pilot or simulated)");
  add_line(lines, flow.unseen, "completed after the interim look");
  add_line(lines, flow.excluded, "excluded");
  add_reasons(lines, flow);
  return lines;
}

struct Box {
  double left_cm;
  double top_cm;
  double width_cm;
  double height_cm;
};

std::string box_of(const Sheet& sheet, const Box& box) {
  return fmt::format(
      "set object rectangle from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} fs "
      "empty border lc rgb '{}' lw 1.2\n",
      box.left_cm / sheet.width_cm, 1.0 - (box.top_cm + box.height_cm) / sheet.height_cm,
      (box.left_cm + box.width_cm) / sheet.width_cm, 1.0 - box.top_cm / sheet.height_cm, kInk);
}

std::string arrow_of(const Sheet& sheet, double x_cm, double y_cm, double to_x_cm, double to_y_cm) {
  return fmt::format(
      "set arrow from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} head filled "
      "size screen 0.012, 20 lw 1.2 lc rgb '{}'\n",
      x_cm / sheet.width_cm, 1.0 - y_cm / sheet.height_cm, to_x_cm / sheet.width_cm,
      1.0 - to_y_cm / sheet.height_cm, kInk);
}

std::string main_box(const Sheet& sheet, double top_cm, const std::string& first,
                     const std::string& second) {
  const double middle_cm = kBoxLeft_cm + 0.5 * kBoxWidth_cm;
  return box_of(sheet, {kBoxLeft_cm, top_cm, kBoxWidth_cm, 1.2}) +
         text_on_sheet(sheet, first, middle_cm, top_cm + (second.empty() ? 0.6 : 0.4), "center") +
         (second.empty() ? "" : text_on_sheet(sheet, second, middle_cm, top_cm + 0.82, "center"));
}

std::string side_box(const Sheet& sheet, double top_cm, const std::vector<std::string>& lines) {
  std::string script = box_of(sheet, {kSideLeft_cm, top_cm, kSideWidth_cm,
                                      0.3 + kLine_cm * static_cast<double>(lines.size())});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    // A space at a line's beginning is lost in SVG: further in by place instead.
    const std::size_t text = lines[i].find_first_not_of(' ');
    script += text_on_sheet(sheet, lines[i].substr(text),
                            kSideLeft_cm + 0.25 + 0.1 * static_cast<double>(text),
                            top_cm + 0.37 + kLine_cm * static_cast<double>(i));
  }
  return script;
}

}  // namespace

std::optional<Figure> flow_figure(const StudyReport& report) {
  const ParticipantFlow& flow = report.collection.flow;
  if (flow.enrolled == 0) return {};
  std::vector<std::string> lines = left_out(flow);
  const int missing = flow.enrolled - flow.analysed;
  if (!lines.empty()) lines.insert(lines.begin(), fmt::format("not analysed (n = {})", missing));
  const double side_cm = lines.empty() ? 0.0 : 0.3 + kLine_cm * static_cast<double>(lines.size());
  const double between_cm = std::max(1.0, side_cm + 0.5);
  const double top_cm = 0.6;
  const Sheet sheet{kWidth_cm, top_cm + 1.2 + between_cm + 1.2 + 0.3, report.simulated};
  const double middle_cm = kBoxLeft_cm + 0.5 * kBoxWidth_cm;
  const double turn_cm = top_cm + 1.2 + 0.5 * between_cm;

  Figure figure{.id = "participant-flow", .caption = {}, .alt = {}, .script = {}};
  figure.width_cm = sheet.width_cm;
  figure.height_cm = sheet.height_cm;
  figure.caption = stamped(report.simulated, "participants from enrolment to analysis.");
  figure.alt = fmt::format("{} participants enrolled, {} analysed with {} trials.", flow.enrolled,
                           flow.analysed, report.trials);
  for (const std::string& line : lines)
    figure.alt += " " + line.substr(line.find_first_not_of(' ')) + ";";
  figure.script =
      sheet_head(sheet) + panel_at(sheet, {0.0, 0.0, 0.0, 0.0}) +
      "unset border\nunset tics\nunset grid\nset xrange [0:1]\nset yrange [0:1]\n" +
      main_box(sheet, top_cm, fmt::format("enrolled (n = {})", flow.enrolled), "") +
      arrow_of(sheet, middle_cm, top_cm + 1.2, middle_cm, top_cm + 1.2 + between_cm) +
      main_box(sheet, top_cm + 1.2 + between_cm, fmt::format("analysed (n = {})", flow.analysed),
               fmt::format("{} trials", report.trials));
  if (!lines.empty()) {
    figure.script += arrow_of(sheet, middle_cm, turn_cm, kSideLeft_cm, turn_cm) +
                     side_box(sheet, turn_cm - 0.5 * side_cm, lines);
  }
  figure.script += "plot NaN notitle\n";
  return figure;
}

}  // namespace touchtrial::analysis
