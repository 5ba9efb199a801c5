/// \file What a protocol finds in a study's outcomes, for every rendering: terminal, JSON, page,
/// figures and tables. Commands and exports know the analysis of a protocol by this interface
/// alone.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/figures/figure.hpp"
#include "analysis/outcomes.hpp"
#include "analysis/page/study_document.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// Where the traces of trials are read from.
struct TraceSource {
  const store::StudyStore& store;
  const design::StudyKey& key;
};

/// What somebody asks of a report beside its tables.
struct ReportWishes {
  enum class Traces { if_few, yes, no };

  const TraceSource* source = nullptr;  ///< null: nothing that needs traces is made
  bool page = false;                    ///< for a page with figures, not the terminal alone
  Traces traces = Traces::if_few;       ///< read them for what needs every trace, such as cues
  std::string trial{};            ///< an exploration to draw, as "P01:3"; empty: none is named
  bool published_values = false;  ///< show what the source publication found beside the figures
  std::function<void(int done, int of)> progress{};  ///< of reading traces
};

/// A study's results. Immutable and thread-safe.
class Results {
 public:
  virtual ~Results() = default;

  /// One JSON object, indented, ending with a line feed; numbers that do not exist are null.
  [[nodiscard]] virtual std::string json() const = 0;
  /// What a terminal of 100 columns or more shows, ending with a line feed. By default the page's
  /// sections.
  [[nodiscard]] virtual std::string text() const;
  /// The figures to draw, in the order of the document. \param stamp  further_stamp of the study
  [[nodiscard]] virtual std::vector<Figure> figures(const std::string& stamp) const;
  /// The page. \param pictures  the figures, drawn
  [[nodiscard]] virtual Document document(const Provenance& provenance,
                                          const Pictures& pictures) const = 0;
};

/// A table of results in a file of its own.
struct ResultTable {
  std::string file;  ///< name
  DataTable table;
};

/// The part of a protocol that reads outcomes. Stateless and thread-safe.
class ProtocolAnalysis {
 public:
  virtual ~ProtocolAnalysis() = default;

  /// \param outcomes  unblinded; need not outlive the results
  /// \throws UsageError if the protocol cannot do what is wished, and names the wish
  /// \throws VerificationError if a trace does not open
  [[nodiscard]] virtual std::unique_ptr<const Results> results(
      const Outcomes& outcomes, const ReportWishes& wishes) const = 0;
  /// Tables that `export --format csv` writes beside those of every study.
  [[nodiscard]] virtual std::vector<ResultTable> tables(const Outcomes& outcomes) const;
  /// Writes what `export --format r` gives: a table, a script that fits a model to it, and how.
  /// \return the files, in the order written
  /// \throws UsageError if the protocol has no such model
  /// \throws FileError if the folder or a file cannot be written
  virtual std::vector<std::filesystem::path> export_model(
      const store::StudyStore& store, const Outcomes& outcomes,
      const std::filesystem::path& folder) const;
};

/// Makes a protocol's analysis known. Call before the first report; not thread-safe.
/// \param protocol  its name; both arguments outlive the program's use of them
void add_analysis(std::string_view protocol, const ProtocolAnalysis& analysis);

/// \throws StudyError if the study's protocol has no analysis
[[nodiscard]] const ProtocolAnalysis& analysis_of(const design::Study& study);

}  // namespace touchtrial::analysis
