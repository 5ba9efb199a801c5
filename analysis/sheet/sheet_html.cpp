#include "analysis/escaping.hpp"
#include "analysis/sheet/stimulus_sheet.hpp"
#include "core/bytes.hpp"

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr const char* kUnblinds =
    "This sheet unblinds: it says which code is which stimulus. Keep it with the key, away from "
    "participants and from whoever runs sessions.";

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>
:root { color-scheme: light; }
body { font: 14px/1.4 system-ui, "DejaVu Sans", sans-serif; color: #1a1a1a; background: #fff;
       margin: 24px auto; max-width: 1500px; padding: 0 20px; }
h1 { font-size: 24px; margin: 0 0 4px; }
.about { color: #555; margin: 0 0 12px; overflow-wrap: anywhere; }
.unblinds { border-left: 5px solid #b3261e; background: #fdf0ef; color: #7a1a14; padding: 8px 12px;
            margin: 0 0 20px; font-weight: 600; }
table { border-collapse: collapse; margin: 0 0 36px; width: 100%; table-layout: fixed; }
col.names { width: 230px; }
th, td { padding: 4px 7px; vertical-align: top; text-align: left; }
thead th { font-weight: normal; padding-bottom: 8px; }
thead strong { display: block; font-size: 17px; overflow-wrap: anywhere; }
thead small, figcaption { display: block; color: #555; font-size: 12px; overflow-wrap: anywhere; }
code { font: 12px "DejaVu Sans Mono", ui-monospace, monospace; color: #7a1a14; }
tbody th { font-weight: normal; color: #333; }
tbody th small { display: block; color: #777; font-size: 12px; }
tr.figure td { font-variant-numeric: tabular-nums; }
tr.figure td, tr.figure th { border-top: 1px solid #e4e4e4; padding: 3px 7px; }
tr.figure th small { display: inline; }
figure { margin: 0; }
img { display: block; width: 100%; max-width: 300px; height: auto; border: 1px solid #ddd; }
@page { size: A4 landscape; margin: 10mm; }
@media print {
  body { font-size: 7.5pt; line-height: 1.25; margin: 0; padding: 0; max-width: none; }
  h1 { font-size: 13pt; }
  .about { margin-bottom: 1.5mm; }
  .unblinds { margin-bottom: 2mm; padding: 1mm 2mm; }
  table { break-inside: avoid; break-after: page; margin: 0; }
  table:last-of-type { break-after: auto; }
  col.names { width: 50mm; }
  thead strong { font-size: 10pt; }
  thead th { padding-bottom: 1mm; }
  th, td { padding: 0.5mm 1mm; }
  tr.figure td, tr.figure th { padding: 0.2mm 1mm; }
  img { max-width: 30mm; }
  code, thead small, figcaption, tbody th small { font-size: 6.5pt; }
}
</style>
)";

/// A number of a stimulus, as it stands below its pictures.
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

/// A number's name and its value for every card of a line.
struct SheetRow {
  std::string name;
  std::string unit;  ///< empty if the values contain it
  std::vector<std::string> values;
};

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

/// The size of the picture on the plane.
std::string size_of(const SheetCard& card) {
  return fmt::format("{:g} x {:g} mm", card.geometry.width_mm(), card.geometry.height_mm());
}

/// The size of the enlarged patch on the plane.
std::string patch_of(const SheetCard& card) {
  const double pitch_mm = card.geometry.pitch_mm;
  return fmt::format("{:g} x {:g} mm", card.patch.width * pitch_mm, card.patch.height * pitch_mm);
}

std::string heading_of(const StimulusSheet& sheet) {
  return "Stimuli of the study " + sheet.study + (sheet.simulated ? ", simulated" : "");
}

std::string figure(const Bytes& png, const std::string& what, const std::string& caption) {
  return "<td><figure><img alt=\"" + xml_escaped(what) + "\" src=\"data:image/png;base64," +
         to_base64(png) + "\"><figcaption>" + xml_escaped(caption) + "</figcaption></figure></td>";
}

std::string head_of(const SheetCard& card) {
  return "<th scope=\"col\"><strong>" + xml_escaped(title_of(card)) + "</strong>" +
         xml_escaped(card.method) + "<small>" + xml_escaped(card.image) + "</small><code>" +
         card.code + "</code></th>";
}

/// A row of pictures.
/// \param cell  makes one from a card
template <typename Cell>
std::string picture_row(const std::vector<SheetCard>& line, const char* name, const char* note,
                        const Cell& cell) {
  std::string row = fmt::format("<tr><th scope=\"row\">{}<small>{}</small></th>", name, note);
  for (const SheetCard& card : line) row += cell(card) + "\n";
  return row + "</tr>\n";
}

std::string picture_rows(const std::vector<SheetCard>& line) {
  const auto named = [](const SheetCard& card) { return title_of(card) + ", " + card.method; };
  return picture_row(line, "picture", "as participants see it",
                     [&](const SheetCard& card) {
                       return figure(engine::png_bytes(card.picture),
                                     "picture of " + title_of(card), size_of(card));
                     }) +
         picture_row(
             line, "texture", "mid-grey is none; contrast times 3; the frame is enlarged below",
             [&](const SheetCard& card) {
               return figure(engine::png_bytes(card.texture), "texture of " + named(card), "");
             }) +
         picture_row(line, "lateral force",
                     "in the frame, as the pack holds it, from bright to dark",
                     [&](const SheetCard& card) {
                       return figure(engine::png_bytes(card.arrows),
                                     "force arrows of " + named(card), patch_of(card));
                     });
}

std::string table_of(const std::vector<SheetCard>& line, const std::string& level_of) {
  std::string table = "<table>\n<colgroup><col class=\"names\">";
  // Short lines have as many columns as long ones.
  for (std::size_t i = 0; i < kMaxSheetColumns; ++i) table += "<col>";
  table += "</colgroup>\n<thead><tr><td></td>";
  for (const SheetCard& card : line) table += head_of(card);
  for (std::size_t i = line.size(); i < kMaxSheetColumns; ++i) table += "<td></td>";
  table += "</tr></thead>\n<tbody>\n" + picture_rows(line);
  for (const SheetRow& row : figure_rows(line, level_of)) {
    table += "<tr class=\"figure\"><th scope=\"row\">" + row.name + " <small>" + row.unit +
             "</small></th>";
    for (const std::string& value : row.values) table += "<td>" + value + "</td>";
    table += "</tr>\n";
  }
  return table + "</tbody>\n</table>\n";
}

}  // namespace

std::string sheet_html(const StimulusSheet& sheet) {
  const std::string heading = xml_escaped(heading_of(sheet));
  std::string html = kHead;
  html += "<title>" + heading + "</title>\n</head>\n<body>\n<h1>" + heading + "</h1>\n";
  html += "<p class=\"about\">" + xml_escaped(sheet.protocol + "; " + sheet.rendering) +
          "<br>seal " + sheet.seal + "</p>\n";
  html += "<p class=\"unblinds\" role=\"note\">" + std::string(kUnblinds) + "</p>\n";
  for (const auto& line : sheet.lines) html += table_of(line, sheet.level_of);
  return html + "</body>\n</html>\n";
}

}  // namespace touchtrial::analysis
