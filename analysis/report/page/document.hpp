/// \file A report as a document, and its renderings as HTML, Markdown, LaTeX and plain text. All
/// texts are plain UTF-8 that may contain anything (labels and reasons are the user's); the
/// renderings escape them. Equal documents give equal bytes. All functions are thread-safe.
#pragma once

#include "analysis/report/bibliography.hpp"
#include "analysis/report/text_table.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace touchtrial::analysis {

/// One sentence or more, with the publications that support it.
struct Cited {
  std::string text;
  std::vector<Source> sources{};
  std::string lead{};  ///< stands before the text, emphasised: a verdict in a word or two
};

enum class Align { left, right };

struct Column {
  std::string title;
  Align align = Align::right;
};

/// \param titles  the first one's column heads the rows, and so stands left
/// \param left  titles of the other columns that stand left
[[nodiscard]] std::vector<Column> columns_of(const std::vector<std::string>& titles,
                                             const std::vector<std::string>& left = {});

struct Cell {
  std::string text;
  bool strong = false;  ///< emphasised, for example the correct answers in a confusion matrix

  Cell(std::string shown, bool emphasised = false)  // NOLINT(google-explicit-constructor)
      : text(std::move(shown)), strong(emphasised) {}
  Cell(const char* shown) : text(shown) {}  // NOLINT(google-explicit-constructor)
};

/// The first cell of each row is the header of the row.
struct Table {
  std::string id;  ///< unique; characters [a-z0-9-]; anchor and file name
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};
  std::vector<Cited> notes{};  ///< stand below the table and explain its numbers
};

struct Picture {
  std::string id;         ///< unique; characters [a-z0-9-]
  std::string caption;    ///< with its stamp, if any
  std::string alt;        ///< what it shows, in words
  std::string svg;        ///< a whole SVG file; empty if it could not be drawn
  std::string section{};  ///< id of the section or subheading below which framed_document puts it
};

struct Subheading {
  std::string id;
  std::string title;
};

/// Warnings against misreading the report.
struct Warnings {
  std::vector<std::string> sentences;
  std::string title{};  ///< may be empty
};

/// Names and their meanings.
struct Definitions {
  std::vector<std::pair<std::string, std::string>> entries;
};

/// One step of the participants' flow, and the participants who leave before the next step.
struct FlowStep {
  std::string text;
  std::vector<std::string> leaving{};
};
struct Flow {
  std::string id;
  std::string caption;
  std::vector<FlowStep> steps;
};

using Block = std::variant<Cited, Table, Picture, Subheading, Warnings, Definitions, Flow>;

struct Section {
  std::string id;
  std::string title;
  std::vector<Block> blocks;
  bool page_only = false;  ///< left out of the text for a terminal
  /// What only specialists read: folded on the page, and left out in print and on a terminal.
  std::vector<Block> more{};

  /// Whether all of it is folded.
  [[nodiscard]] bool is_folded() const { return blocks.empty() && !more.empty(); }
};

/// A section's blocks, then those that are folded.
[[nodiscard]] std::vector<const Block*> all_blocks(const Section& section);

struct Document {
  std::string title;
  std::string stamp;  ///< for example "SIMULATED"; may be empty; stands on every table
  std::vector<std::string> banners;   ///< warnings at the top of the page
  Definitions header;                 ///< study, program and evidence; after the sections
  std::vector<Section> sections;      ///< the most important first
  std::string colophon;               ///< last line
  bool numbered = true;               ///< whether the page numbers its tables and figures
  std::string about = "This report";  ///< the title of the header
};

/// Every cited source, in the order of first citation, those that only folded blocks cite at the
/// end. Reference number n is element n - 1.
[[nodiscard]] std::vector<Source> references_of(const Document& document);
/// How many of references_of are cited outside folded blocks.
[[nodiscard]] std::size_t references_in_print(const Document& document);
/// Every source that one table cites, in the order of first citation.
[[nodiscard]] std::vector<Source> references_of(const Table& table);

/// The citations of a text, for example " [1, 3]"; empty without a source.
[[nodiscard]] std::string citation_mark(const Cited& cited, const std::vector<Source>& references);

/// The number of a source in a list of references, from 1; 0 if the list does not contain it.
[[nodiscard]] std::size_t reference_number(Source source, const std::vector<Source>& references);

/// The caption, followed by the words of the document's stamp that it does not contain yet.
[[nodiscard]] std::string stamped(const std::string& caption, const std::string& stamp);

/// The tables and warnings of a document, in the sections that have some; without its header.
[[nodiscard]] Document tables_alone(const Document& document);

/// Every table of a document, in order.
[[nodiscard]] std::vector<const Table*> tables_of(const Document& document);

/// One HTML page without scripts and without references to other files. Sections that are folded
/// as a whole follow the others; the numbers of folded tables and figures begin with S.
[[nodiscard]] std::string page_html(const Document& document);

/// One table in GitHub's Markdown, with its notes and references.
[[nodiscard]] std::string table_markdown(const Table& table, const std::string& stamp);

/// A document in GitHub's Markdown, with the references at the end.
/// \param pictures  the folder of the pictures' files, relative to the Markdown file: "images"; a
///   picture that could not be drawn is described instead
[[nodiscard]] std::string document_markdown(const Document& document, const std::string& pictures);

/// One table as LaTeX for \input: a float, or a longtable if it has many rows. The preamble needs
/// booktabs and longtable, and for pdfLaTeX also T1 fonts and UTF-8 input.
[[nodiscard]] std::string table_latex(const Table& table, const std::string& stamp);
/// The tables and warnings of the document in sections, as LaTeX for \input, with the references at
/// the end.
[[nodiscard]] std::string tables_latex(const Document& document);

/// The document as text for a terminal: the sections that are not for the page alone, then the
/// header. Without pictures, subheadings, the notes that only name a method, which are those with
/// sources, and what is folded, but for its warnings. An asterisk precedes emphasised cells. Begins
/// with the banners and ends with the stamp, if there are any.
/// \param width  columns of the terminal, >= 80
[[nodiscard]] std::string document_text(const Document& document, std::size_t width = kTextWidth);

}  // namespace touchtrial::analysis
