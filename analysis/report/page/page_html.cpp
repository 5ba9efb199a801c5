#include "analysis/report/escaping.hpp"
#include "analysis/report/figures/svg.hpp"
#include "analysis/report/page/document.hpp"
#include "analysis/report/page/page_style.hpp"
#include "core/text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kMaxUnfoldedRows = 60;  ///< longer tables are folded
constexpr std::size_t kMaxUnbrokenRows = 12;  ///< longer tables may break across printed pages
/// Text columns with longer cells get a minimum width.
constexpr std::size_t kWideHtmlCell = 40;

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
)";

/// The numbers of tables and figures so far.
struct Numbers {
  int tables = 0;
  int figures = 0;
};

/// Folded parts have separate numbers, so that the numbers in print have no gaps.
struct Writer {
  const Document& document;
  std::vector<Source> references;
  Numbers unfolded_numbers{};
  Numbers folded_numbers{};
  bool is_folding = false;

  std::string next_number(int Numbers::*kind) {
    Numbers& numbers = is_folding ? folded_numbers : unfolded_numbers;
    return (is_folding ? "S" : "") + std::to_string(++(numbers.*kind));
  }
};

/// Escaped text, with no line break within "p < 0.001" or "N = 20".
std::string html_text(const std::string& text) {
  constexpr const char* kNoBreak = "\u00a0";
  std::string html = xml_escaped(text);
  for (const std::string sign : {"=", "&lt;"}) {
    for (std::size_t at = html.find(sign + " "); at != std::string::npos;
         at = html.find(sign + " ", at + 1)) {
      html.replace(at + sign.size(), 1, kNoBreak);
      if (at > 0 && html[at - 1] == ' ') html.replace(at - 1, 1, kNoBreak);
    }
  }
  return html;
}

std::string cited_html(const Writer& writer, const CitedText& cited) {
  std::string text = html_text(cited.text);
  if (!cited.lead.empty()) text = "<strong>" + html_text(cited.lead) + "</strong> " + text;
  for (std::size_t i = 0; i < cited.sources.size(); ++i) {
    const std::size_t number = reference_number(cited.sources[i], writer.references);
    text += fmt::format("{}<a href=\"#reference-{}\" aria-label=\"reference {}\">{}</a>",
                        i == 0 ? " [" : ", ", number, number, number);
  }
  return cited.sources.empty() ? text : text + "]";
}

std::string html_of(Writer& writer, const CitedText& paragraph) {
  return (paragraph.lead.empty() ? "<p>" : "<p class=\"lead\">") + cited_html(writer, paragraph) +
         "</p>\n";
}

std::string html_of(Writer& /*writer*/, const Subheading& heading) {
  return "<h3 id=\"" + heading.id + "\">" + html_text(heading.title) + "</h3>\n";
}

std::string html_of(Writer& /*writer*/, const Warnings& warnings) {
  if (warnings.sentences.empty()) return "";
  std::string html = "<div class=\"warnings\">\n";
  if (!warnings.title.empty()) html += "<p>" + html_text(warnings.title) + "</p>\n";
  html += "<ul>\n";
  for (const std::string& sentence : warnings.sentences)
    html += "<li>" + html_text(sentence) + "</li>\n";
  return html + "</ul>\n</div>\n";
}

std::string html_of(Writer& /*writer*/, const Definitions& definitions) {
  std::string html = "<dl>\n";
  for (const auto& [name, meaning] : definitions.entries) {
    html += "<dt>" + html_text(name) + "</dt><dd>" + html_text(meaning) + "</dd>\n";
  }
  return definitions.entries.empty() ? "" : html + "</dl>\n";
}

std::string header_row(const Table& table) {
  std::string html = "<thead><tr>";
  for (const Column& column : table.columns) {
    html += fmt::format("<th scope=\"col\"{}>{}</th>",
                        column.align == Align::left ? " class=\"l\"" : "", html_text(column.title));
  }
  return html + "</tr></thead>\n";
}

std::string cell_html(const Column& column, const Cell& cell, bool wide) {
  std::string kinds = column.align == Align::left ? "l" : "";
  if (wide) kinds += " wide";
  if (cell.strong) kinds += kinds.empty() ? "s" : " s";
  return (kinds.empty() ? "<td>" : "<td class=\"" + kinds + "\">") + html_text(cell.text) + "</td>";
}

bool is_wide(const Table& table, std::size_t column) {
  return table.columns[column].align == Align::left &&
         std::any_of(table.rows.begin(), table.rows.end(), [&](const std::vector<Cell>& row) {
           return row[column].text.size() > kWideHtmlCell;
         });
}

std::string body_rows(const Table& table) {
  std::vector<bool> wide;
  for (std::size_t i = 0; i < table.columns.size(); ++i) wide.push_back(is_wide(table, i));
  std::string html = "<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    html += "<tr><th scope=\"row\">" + html_text(row[0].text) + "</th>";
    for (std::size_t i = 1; i < row.size(); ++i) {
      html += cell_html(table.columns[i], row[i], wide[i]);
    }
    html += "</tr>\n";
  }
  return html + "</tbody>\n";
}

/// "<b>Table 3.</b> "; empty if tables and figures have no numbers
std::string number_of(const Writer& writer, const char* kind, const std::string& number) {
  return writer.document.numbered ? fmt::format("<b>{} {}.</b> ", kind, number) : "";
}

std::string notes_html(const Writer& writer, const Table& table) {
  if (table.notes.empty()) return "";
  std::string html = "<div class=\"notes\">\n";
  for (const CitedText& note : table.notes) html += "<p>" + cited_html(writer, note) + "</p>\n";
  return html + "</div>\n";
}

std::string html_of(Writer& writer, const Table& table) {
  const std::string number = writer.next_number(&Numbers::tables);
  const std::string caption = fmt::format("{}{}", number_of(writer, "Table", number),
                                          html_text(stamped(table.caption, writer.document.stamp)));
  std::string html = fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" "
      "aria-labelledby=\"table-{0}-caption\">\n"
      "<table>\n<caption id=\"table-{0}-caption\"><span>{1}</span></caption>\n",
      table.id, caption);
  html += header_row(table) + body_rows(table) + "</table>\n</div>\n" + notes_html(writer, table);
  if (table.rows.size() > kMaxUnfoldedRows) {
    html = fmt::format("<details>\n<summary>Table {}, {} rows</summary>\n", number,
                       table.rows.size()) +
           html + "</details>\n";
  }
  return fmt::format("<div class=\"table{}\" id=\"table-{}\">\n",
                     table.rows.size() <= kMaxUnbrokenRows ? " whole" : "", table.id) +
         html + "</div>\n";
}

/// The width in an SVG file, by default that of a page.
double width_cm(std::string_view svg) {
  constexpr std::string_view kWidth = "width=\"";
  constexpr double kPage_cm = 17.0;
  const std::size_t begin = svg.find(kWidth);
  if (begin == std::string_view::npos) return kPage_cm;
  const std::string_view value = svg.substr(begin + kWidth.size());
  const std::size_t end = value.find("cm\"");
  return end > 8 ? kPage_cm : number_in<double>(value.substr(0, end)).value_or(kPage_cm);
}

std::string html_of(Writer& writer, const Picture& picture) {
  const std::string svg = inline_svg(picture.svg, "figure-" + picture.id + "-");
  const std::string number = writer.next_number(&Numbers::figures);
  const std::string label = number_of(writer, "Figure", number);
  const std::string open = "<figure id=\"figure-" + picture.id + "\">\n";
  const std::string& stamp = writer.document.stamp;
  if (svg.empty()) {
    // The caption would describe marks that are missing.
    return open + fmt::format("<figcaption>{}<b>Not drawn.</b> {}</figcaption>\n</figure>\n", label,
                              html_text(stamped(picture.alt, stamp)));
  }
  return open +
         fmt::format(
             "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Figure {0}\">"
             "<div class=\"plot\" style=\"--cm: {1}\" role=\"img\" aria-label=\"{2}\">\n{3}\n"
             "</div></div>\n<figcaption>{4}{5}</figcaption>\n"
             "<details><summary>{4}In words</summary><p>{2}</p></details>\n</figure>\n",
             number, width_cm(picture.svg), html_text(picture.alt), svg, label,
             html_text(stamped(picture.caption, stamp)));
}

std::string html_of(Writer& writer, const Flow& flow) {
  std::string html = "<figure class=\"flow\" id=\"figure-" + flow.id + "\">\n<ol>\n";
  for (const FlowStep& step : flow.steps) {
    html += "<li><div class=\"box\">" + html_text(step.text) + "</div>";
    if (!step.losses.empty()) html += "<ul class=\"leaving\">";
    for (const std::string& loss : step.losses) html += "<li>" + html_text(loss) + "</li>";
    html += step.losses.empty() ? "</li>\n" : "</ul></li>\n";
  }
  return html + fmt::format("</ol>\n<figcaption><b>Figure {}.</b> {}</figcaption>\n</figure>\n",
                            writer.next_number(&Numbers::figures),
                            html_text(stamped(flow.caption, writer.document.stamp)));
}

std::string blocks_html(Writer& writer, const std::vector<Block>& blocks) {
  std::string html;
  for (const Block& block : blocks) {
    html += std::visit([&](const auto& content) { return html_of(writer, content); }, block);
  }
  return html;
}

/// "2 tables, 1 figure", or "notes" without tables and figures
std::string contents_of(const std::vector<Block>& blocks) {
  int tables = 0;
  int figures = 0;
  for (const Block& block : blocks) {
    tables += std::holds_alternative<Table>(block) ? 1 : 0;
    figures += std::holds_alternative<Picture>(block) ? 1 : 0;
  }
  std::string text = tables > 0 ? counted(tables, "table") : "";
  if (figures > 0) text += (text.empty() ? "" : ", ") + counted(figures, "figure");
  return text.empty() ? "notes" : text;
}

std::string folded_html(Writer& writer, const Section& section, const std::string& title) {
  if (section.folded_blocks.empty()) return "";
  writer.is_folding = true;
  const std::string html = blocks_html(writer, section.folded_blocks);
  writer.is_folding = false;
  return "<details class=\"more\">\n<summary>" + title + "</summary>\n" + html + "</details>\n";
}

std::string section_html(Writer& writer, const Section& section) {
  return fmt::format("<section aria-labelledby=\"{0}\">\n<h2 id=\"{0}\">{1}</h2>\n", section.id,
                     html_text(section.title)) +
         blocks_html(writer, section.blocks) +
         folded_html(writer, section, "More: " + contents_of(section.folded_blocks)) +
         "</section>\n";
}

constexpr const char* kFurther = "Further analyses";

/// The completely folded sections, under one heading.
std::string further_html(Writer& writer) {
  std::string html;
  for (const Section& section : writer.document.sections) {
    if (!section.is_folded()) continue;
    html +=
        fmt::format("<section class=\"whole-more\" aria-labelledby=\"{}\">\n", section.id) +
        folded_html(writer, section,
                    fmt::format("<h3 id=\"{}\">{}</h3>", section.id, html_text(section.title))) +
        "</section>\n";
  }
  if (html.empty()) return "";
  return "<section class=\"further\" aria-labelledby=\"further\">\n<h2 id=\"further\">" +
         std::string(kFurther) + "</h2>\n" + html + "</section>\n";
}

std::string references_html(const Writer& writer) {
  if (writer.references.empty()) return "";
  std::string html =
      "<section aria-labelledby=\"references\">\n<h2 id=\"references\">References</h2>\n"
      "<ol class=\"references\">\n";
  const std::size_t in_print = printed_reference_count(writer.document);
  const std::size_t count = writer.references.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i == in_print) {
      html += fmt::format(
          "</ol>\n<details class=\"more\">\n<summary>Cited in folded parts: {}</summary>\n"
          "<ol class=\"references\" start=\"{}\">\n",
          count - i, i + 1);
    }
    html += fmt::format("<li id=\"reference-{}\">{}</li>\n", i + 1,
                        html_text(std::string(citation_of(writer.references[i]))));
  }
  return html + (in_print < count ? "</ol>\n</details>\n</section>\n" : "</ol>\n</section>\n");
}

std::string navigation(const Writer& writer) {
  std::string html =
      "<nav aria-labelledby=\"contents\">\n<h2 id=\"contents\">Contents</h2>\n<ul>\n";
  const auto add = [&](const std::string& id, const std::string& title) {
    html += "<li><a href=\"#" + id + "\">" + html_text(title) + "</a></li>\n";
  };
  const std::vector<Section>& sections = writer.document.sections;
  for (const Section& section : sections) {
    if (!section.is_folded()) add(section.id, section.title);
  }
  if (std::ranges::any_of(sections, &Section::is_folded)) add("further", kFurther);
  if (!writer.references.empty()) add("references", "References");
  add("this-report", writer.document.about);
  return html + "</ul>\n</nav>\n";
}

std::string header_html(const Writer& writer) {
  std::string html = "<header>\n";
  for (const std::string& banner : writer.document.banners) {
    html += "<p class=\"banner\">" + html_text(banner) + "</p>\n";
  }
  return html + "<h1>" + html_text(writer.document.title) + "</h1>\n</header>\n";
}

/// The table of contents is after the first section, so that the result is visible at once.
std::string main_html(Writer& writer) {
  std::string html = "<main id=\"main\" tabindex=\"-1\">\n";
  std::string contents = navigation(writer);
  for (const Section& section : writer.document.sections) {
    if (section.is_folded()) continue;
    html += section_html(writer, section) + contents;
    contents.clear();
  }
  html += further_html(writer) + references_html(writer);
  return html + "<section aria-labelledby=\"this-report\">\n<h2 id=\"this-report\">" +
         html_text(writer.document.about) + "</h2>\n" + html_of(writer, writer.document.header) +
         "</section>\n</main>\n";
}

}  // namespace

std::string page_html(const Document& document) {
  Writer writer{document, references_of(document)};
  const std::string title = html_text(stamped(document.title, document.stamp));
  std::string html = kHead + ("<title>" + title + "</title>\n<style>") + std::string(page_style()) +
                     "</style>\n</head>\n<body>\n";
  html += header_html(writer) + main_html(writer) + "<footer>" + html_text(document.colophon) +
          "</footer>\n";
  return html + "</body>\n</html>\n";
}

}  // namespace touchtrial::analysis
