/// \file A report as a document: what it says, before it is HTML, Markdown or LaTeX. All texts are
/// plain UTF-8 that may hold anything (labels and reasons are the user's); renderings escape them.
#pragma once

#include "analysis/page/sources.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace touchtrial::analysis {

/// A sentence or more, and what it rests on.
struct Cited {
  std::string text;
  std::vector<Source> sources{};
};

enum class Align { left, right };

struct Column {
  std::string title;
  Align align = Align::right;
};

struct Cell {
  std::string text;
  bool strong = false;  ///< what the eye is to find first: right answers of a confusion matrix

  Cell(std::string shown, bool found_first = false)  // NOLINT(google-explicit-constructor)
      : text(std::move(shown)), strong(found_first) {}
  Cell(const char* shown) : text(shown) {}  // NOLINT(google-explicit-constructor)
};

/// The first cell of a row is its header.
struct Table {
  std::string id;  ///< unique; [a-z0-9-]: anchor and file name
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};
  std::vector<Cited> notes{};  ///< below it: what its figures are
};

/// A picture that somebody drew.
struct Picture {
  std::string id;       ///< unique, as a table's
  std::string caption;  ///< stamped already, if it is
  std::string alt;      ///< what it shows, in words
  std::string svg;      ///< a whole SVG file; empty: it could not be drawn
};

struct Subheading {
  std::string id;
  std::string title;
};

/// What a reader could take a figure for, wrongly.
struct Warnings {
  std::vector<std::string> sentences;
};

/// Names and what they stand for.
struct Definitions {
  std::vector<std::pair<std::string, std::string>> entries;
};

/// Participants on their way, each step with those who leave before the next.
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
};

/// Whether anything of a section is told in a file of tables.
[[nodiscard]] bool has_tables_or_warnings(const Section& section);

struct Document {
  std::string title;
  std::string stamp;                 ///< "SIMULATED" or empty: goes on every table
  std::vector<std::string> banners;  ///< what has to be known before anything is read
  Definitions header;                ///< which study, which program, which evidence
  std::vector<Section> sections;
  std::string colophon;  ///< last line
};

/// Every source that is cited, in the order of the first citation: reference n is element n - 1.
[[nodiscard]] std::vector<Source> references_of(const Document& document);
/// The same of one table.
[[nodiscard]] std::vector<Source> references_of(const Table& table);

/// "[1, 3]" with a space before it, or nothing.
[[nodiscard]] std::string citation_mark(const Cited& cited, const std::vector<Source>& references);

/// Place of a source in a list of references, from 1; 0: it is not there.
[[nodiscard]] std::size_t reference_number(Source source, const std::vector<Source>& references);

/// A caption with the document's stamp, once.
[[nodiscard]] std::string stamped(const std::string& caption, const std::string& stamp);

/// Every table of a document, in order.
[[nodiscard]] std::vector<const Table*> tables_of(const Document& document);

}  // namespace touchtrial::analysis
