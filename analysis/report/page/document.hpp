/// \file A report as a document, and its renderings as HTML, Markdown, LaTeX and plain text. Texts
/// are plain UTF-8 and may contain anything (users write labels and reasons); renderings escape
/// them. Equal documents give equal bytes. All functions are thread-safe.
#pragma once

#include "analysis/report/bibliography.hpp"
#include "analysis/report/text_table.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace touchtrial::analysis {

/// One or more sentences, with their sources.
struct CitedText {
  std::string text;
  std::vector<Source> sources{};
  std::string lead{};  ///< an emphasised verdict of one or two words before the text
};

enum class Align { left, right };

struct Column {
  std::string title;
  Align align = Align::right;
};

/// \param titles  the first column heads the rows, and is aligned left
/// \param left  titles of other left-aligned columns
[[nodiscard]] std::vector<Column> columns_of(const std::vector<std::string>& titles,
                                             const std::vector<std::string>& left = {});

struct Cell {
  std::string text;
  bool strong = false;  ///< emphasised, such as correct answers in a confusion matrix

  Cell(std::string content, bool emphasised = false)  // NOLINT(google-explicit-constructor)
      : text(std::move(content)), strong(emphasised) {}
  Cell(const char* content) : text(content) {}  // NOLINT(google-explicit-constructor)
};

/// The first cell of each row is the header of the row.
struct Table {
  std::string id;  ///< unique; characters [a-z0-9-]; anchor and file name
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};
  std::vector<CitedText> notes{};  ///< below the table
};

struct Picture {
  std::string id;         ///< unique; characters [a-z0-9-]
  std::string caption;    ///< with its stamp, if any
  std::string alt;        ///< text alternative
  std::string svg;        ///< a whole SVG file; empty if it could not be drawn
  std::string section{};  ///< id of its section or subheading
};

struct Subheading {
  std::string id;
  std::string title;
};

struct Warnings {
  std::vector<std::string> sentences;
  std::string title{};  ///< may be empty
};

struct Definitions {
  std::vector<std::pair<std::string, std::string>> entries;
};

/// One step of the participant flow, and the losses before the next step.
struct FlowStep {
  std::string text;
  std::vector<std::string> losses{};
};
struct Flow {
  std::string id;
  std::string caption;
  std::vector<FlowStep> steps;
};

using Block = std::variant<CitedText, Table, Picture, Subheading, Warnings, Definitions, Flow>;

struct Section {
  std::string id;
  std::string title;
  std::vector<Block> blocks;
  bool page_only = false;  ///< omitted in a terminal
  /// Details for specialists: folded on the page, omitted in print and in a terminal.
  std::vector<Block> folded_blocks{};

  [[nodiscard]] bool is_folded() const { return blocks.empty() && !folded_blocks.empty(); }
};

/// \return pointers to the blocks, then to the folded blocks
[[nodiscard]] std::vector<const Block*> all_blocks(const Section& section);

struct Document {
  std::string title;
  std::string stamp;                  ///< on every table, such as "SIMULATED"; may be empty
  std::vector<std::string> banners;   ///< warnings at the top of the page
  Definitions header;                 ///< study, program and evidence; after the sections
  std::vector<Section> sections;      ///< the most important first
  std::string colophon;               ///< last line
  bool numbered = true;               ///< whether the page numbers its tables and figures
  std::string about = "This report";  ///< title of the header
};

/// All cited sources in the order of first citation; those cited only in folded blocks are last.
/// Reference n is element n - 1.
[[nodiscard]] std::vector<Source> references_of(const Document& document);
/// The number of references_of that are cited outside folded blocks.
[[nodiscard]] std::size_t printed_reference_count(const Document& document);
/// The sources that a table cites, in the order of first citation.
[[nodiscard]] std::vector<Source> references_of(const Table& table);

/// " [1, 3]"; empty without a source
[[nodiscard]] std::string citation_mark(const CitedText& cited,
                                        const std::vector<Source>& references);

/// The number of a source in a list of references, from 1; 0 if the list does not contain it.
[[nodiscard]] std::size_t reference_number(Source source, const std::vector<Source>& references);

/// The caption, followed by the words of the stamp that it does not contain.
[[nodiscard]] std::string stamped(const std::string& caption, const std::string& stamp);

/// A document with only the tables and warnings of another, without its header.
[[nodiscard]] Document tables_only(const Document& document);

/// Every table of a document, in order.
[[nodiscard]] std::vector<const Table*> tables_of(const Document& document);

/// One HTML page without scripts and references to other files. Completely folded sections are
/// last; the numbers of folded tables and figures begin with S.
[[nodiscard]] std::string page_html(const Document& document);

/// One table in GitHub's Markdown, with its notes and references.
[[nodiscard]] std::string table_markdown(const Table& table, const std::string& stamp);

/// A document in GitHub's Markdown, with the references at the end.
/// \param pictures  the folder of pictures, relative to the Markdown file: "images"; a picture that
///   could not be drawn is described
[[nodiscard]] std::string document_markdown(const Document& document, const std::string& pictures);

/// One table as LaTeX for \input: a float, or a longtable if it has many rows. The preamble needs
/// booktabs and longtable, and for pdfLaTeX also T1 fonts and UTF-8 input.
[[nodiscard]] std::string table_latex(const Table& table, const std::string& stamp);
/// The tables and warnings of the document in sections, as LaTeX for \input, with the references at
/// the end.
[[nodiscard]] std::string tables_latex(const Document& document);

/// The document as text for a terminal: banners, sections that are not page_only, header and stamp.
/// Omits pictures, subheadings, notes with sources (these only name a method), and folded blocks
/// except warnings. An asterisk precedes emphasised cells.
/// \param width  columns of the terminal, >= 80
[[nodiscard]] std::string document_text(const Document& document, std::size_t width = kTextWidth);

}  // namespace touchtrial::analysis
