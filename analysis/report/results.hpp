/// \file The interface of a protocol's analysis, which turns outcomes into text, JSON, a page,
/// figures and tables. Commands and exports know the analysis of a protocol only by this interface.
#pragma once

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/methods.hpp"
#include "analysis/report/page/study_document.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// The source from which the traces of trials are read.
struct TraceSource {
  const record::StudyStore& store;
  const study::StudyKey& key;
};

/// What a user wants in a report besides its tables.
struct ReportOptions {
  enum class Traces { if_few, yes, no };

  const TraceSource* source = nullptr;  ///< null: sections that need traces are omitted
  bool page = false;                    ///< make a page with figures, not only terminal text
  Traces traces = Traces::if_few;       ///< read traces for sections that need all, such as cues
  std::string trial{};            ///< an exploration to draw, as "P01:3"; empty: none is named
  bool published_values = false;  ///< show the values of the source publication for comparison
  std::function<void(int done, int of)> progress{};  ///< called while traces are read
};

/// A study's results. Immutable and thread-safe.
class Results {
 public:
  virtual ~Results() = default;

  /// The part that all reports have in common.
  [[nodiscard]] virtual const StudyHead& head() const = 0;
  /// One JSON object, indented, ending with a line feed; numbers that do not exist are null.
  [[nodiscard]] virtual std::string json() const = 0;
  /// The figures to draw, in the order of the document.
  /// \param stamp  further_stamp of the study
  [[nodiscard]] virtual std::vector<Figure> figures(const std::string& stamp) const;
  /// The report, as a page and as text for a terminal.
  /// \param pictures  the drawn figures
  [[nodiscard]] virtual Document document(const Provenance& provenance,
                                          const Pictures& pictures) const = 0;
};

/// Results whose page ends with the study's methods, if a page is requested and its source known.
/// \param outcomes  from which the results were made
[[nodiscard]] std::unique_ptr<const Results> with_methods(std::unique_ptr<const Results> results,
                                                          const Outcomes& outcomes,
                                                          const ReportOptions& wishes,
                                                          const ProtocolMethods& protocol);

/// The answer to the registered question and how the study was collected: what a registered look
/// shows of results, whatever the protocol.
/// \param store  has what is in clear, for the quality of the data
[[nodiscard]] std::unique_ptr<const Results> question_alone(const Results& results,
                                                            const record::StudyStore& store);

/// A table of results in its own file.
struct ResultTable {
  std::string file;  ///< the file's name
  DataTable table;
  bool has_words = false;  ///< personal data: for its reader alone
};

/// A model that R fits to a study's trials, and the content of its files, whose first lines the
/// frame adds.
struct RModel {
  std::string title;   ///< "Mixed model"
  std::string name;    ///< of the files, without extension: "mixed_model"
  DataTable table;     ///< NAME.csv
  std::string script;  ///< NAME.R, which needs lme4 and reads the table
  std::string notes;   ///< NAME.md
};

/// The whole text of NAME.R.
[[nodiscard]] std::string r_script_of(const RModel& model, const Outcomes& outcomes);

/// The part of a protocol that analyses outcomes. Stateless and thread-safe.
class ProtocolAnalysis {
 public:
  virtual ~ProtocolAnalysis() = default;

  /// \param outcomes  unblinded; need not outlive the results
  /// \throws UsageError, naming the wish, if the protocol cannot fulfil one
  /// \throws VerificationError if a trace does not open
  [[nodiscard]] virtual std::unique_ptr<const Results> results(
      const Outcomes& outcomes, const ReportOptions& wishes) const = 0;
  /// Tables that `export --format csv` writes in addition to those of every study.
  [[nodiscard]] virtual std::vector<ResultTable> tables(const Outcomes& outcomes) const;
  /// Columns that tables of trials have in addition, for instance what an adaptive order chose.
  /// Their names are known to meaning_of (exports/dataset.hpp).
  /// \param outcomes  must outlive the columns
  [[nodiscard]] virtual std::vector<TrialColumn> trial_columns(const Outcomes& outcomes) const;
  /// The model of `export --format r`.
  /// \return nothing if the protocol has none
  /// \throws UsageError if this study can have none
  [[nodiscard]] virtual std::optional<RModel> r_model(const Outcomes& outcomes) const;
};

/// Writes NAME.csv, NAME.R and NAME.md of the protocol's model.
/// \return the files, in the order in which they were written
/// \throws UsageError if the study has no model
/// \throws FileError as write_export does
std::vector<std::filesystem::path> export_r_model(const record::StudyStore& store,
                                                  const Outcomes& outcomes,
                                                  const std::filesystem::path& folder);

/// Registers a protocol's analysis. Call before the first report. Not thread-safe.
/// \param protocol  the protocol's name; both arguments must outlive the program's use of them
void add_analysis(std::string_view protocol, const ProtocolAnalysis& analysis);

/// \throws StudyError if the study's protocol has no analysis
[[nodiscard]] const ProtocolAnalysis& analysis_of(const study::Study& study);

}  // namespace touchtrial::analysis
