/// \file The interface of a protocol's analysis, which turns outcomes into text, JSON, a page,
/// figures and tables. Commands and exports use a protocol's analysis only through this interface.
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

/// The database and the key from which trials' traces are read.
struct TraceSource {
  const record::StudyStore& store;
  const study::StudyKey& key;
};

/// What a report contains in addition to its tables.
struct ReportOptions {
  enum class Traces { if_few, yes, no };

  const TraceSource* source = nullptr;  ///< null: sections that need traces are omitted
  bool page = false;                    ///< make a page with figures, not only terminal text
  Traces traces = Traces::if_few;       ///< read traces for sections that need all, such as cues
  std::string trial{};                  ///< an exploration to draw, such as "P01:3"; may be empty
  bool published_values = false;  ///< show the values of the source publication for comparison
  std::function<void(int done, int total)> progress{};  ///< called while traces are read
};

/// A study's results. Immutable and thread-safe.
class Results {
 public:
  virtual ~Results() = default;

  /// The common part of all reports.
  [[nodiscard]] virtual const StudyHead& head() const = 0;
  /// One JSON object, indented, ending with a line feed; missing numbers are null.
  [[nodiscard]] virtual std::string json() const = 0;
  /// The figures to draw, in the order of the document.
  /// \param stamp  further_stamp of the study
  [[nodiscard]] virtual std::vector<Figure> figures(const std::string& stamp) const;
  /// The report, as a page and as text for a terminal.
  /// \param pictures  the drawn figures
  [[nodiscard]] virtual Document document(const Provenance& provenance,
                                          const Pictures& pictures) const = 0;
};

/// Adds the study's methods to the end of the page, if `options` request a page and have a source.
/// \param outcomes  of the results
[[nodiscard]] std::unique_ptr<const Results> with_methods(std::unique_ptr<const Results> results,
                                                          const Outcomes& outcomes,
                                                          const ReportOptions& options,
                                                          const ProtocolMethods& protocol);

/// Refuses drawings of explorations and ideal observers.
/// \param reason  why explorations are not drawn
/// \throws UsageError if an option requests one of them
void refuse_exploration_options(const ReportOptions& options, const std::string& reason);

/// What a registered look shows, for any protocol: the answer to the registered question, and data
/// collection.
/// \param store  has the public data on collection
[[nodiscard]] std::unique_ptr<const Results> registered_answer_only(
    const Results& results, const record::StudyStore& store);

/// A table of results in its own file.
struct ResultTable {
  std::string file;  ///< name
  DataTable table;
  bool has_free_text = false;  ///< personal data: only the owner may read the file
};

/// A model that R fits to a study's trials: the content of its files, without their first lines.
struct RModel {
  std::string title;   ///< "Mixed model"
  std::string name;    ///< of the files, without extension: "mixed_model"
  DataTable table;     ///< NAME.csv
  std::string script;  ///< NAME.R, which needs lme4 and reads the table
  std::string notes;   ///< NAME.md
};

/// The complete text of NAME.R.
[[nodiscard]] std::string r_script_of(const RModel& model, const Outcomes& outcomes);

/// The part of a protocol that analyses outcomes. Stateless and thread-safe.
class ProtocolAnalysis {
 public:
  virtual ~ProtocolAnalysis() = default;

  /// \param outcomes  unblinded; need not outlive the results
  /// \throws UsageError, naming the option, if the protocol does not support one
  /// \throws VerificationError if a trace does not open
  [[nodiscard]] virtual std::unique_ptr<const Results> results(
      const Outcomes& outcomes, const ReportOptions& options) const = 0;
  /// Tables that `export --format csv` writes in addition to the tables of every study.
  [[nodiscard]] virtual std::vector<ResultTable> tables(const Outcomes& outcomes) const;
  /// Additional columns of trial tables, such as the choices of an adaptive order. meaning_of
  /// (exports/column_meanings.hpp) must contain their names.
  /// \param outcomes  must outlive the columns
  [[nodiscard]] virtual std::vector<TrialColumn> trial_columns(const Outcomes& outcomes) const;
  /// The model of `export --format r`.
  /// \return nothing if the protocol has none
  /// \throws UsageError if the study's design does not permit it
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
/// \param protocol  its name; both arguments must outlive all reports
void add_analysis(std::string_view protocol, const ProtocolAnalysis& analysis);

/// \throws StudyError if the study's protocol has no analysis
[[nodiscard]] const ProtocolAnalysis& analysis_of(const study::Study& study);

}  // namespace touchtrial::analysis
