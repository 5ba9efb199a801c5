/// \file The paragraphs of a report's methods. Private to analysis/report.
#pragma once

#include "analysis/report/methods.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// A paragraph in the making. Sources are named in the text, as "(Holm, 1979)", and kept for the
/// list of references.
class Paragraph {
 public:
  /// \param sentence  with its full stop; empty: none
  /// \param sources  named before the full stop
  void say(std::string_view sentence, const std::vector<Source>& sources = {});
  void say(const Sentences& sentences);

  [[nodiscard]] const Cited& cited() const noexcept { return cited_; }

 private:
  Cited cited_;
};

/// "Brown et al., 2001"
[[nodiscard]] std::string author_and_year(Source source);

/// "exploration from landing: at least 5 s; contact: at least 5 s"
[[nodiscard]] std::string joined_fields(
    const std::vector<std::pair<std::string, std::string>>& fields);

/// What somebody wrote in a study file, as one line in quotation marks.
[[nodiscard]] std::string quoted_statement(const std::string& text);

[[nodiscard]] Cited participants_paragraph(const StudyHead& head, const Outcomes& outcomes);
[[nodiscard]] Cited stimuli_paragraph(const StudyHead& head, const Outcomes& outcomes,
                                      const RecordedStudy& recorded);
[[nodiscard]] Cited procedure_paragraph(const StudyHead& head, const Outcomes& outcomes,
                                        const ProtocolMethods& protocol);
[[nodiscard]] Cited analysis_paragraph(const Outcomes& outcomes, const RecordedStudy& recorded,
                                       const ProtocolMethods& protocol);

/// The records of the sessions that count.
[[nodiscard]] std::vector<const SessionRecord*> counted_records(const StudyHead& head,
                                                                const Outcomes& outcomes);

}  // namespace touchtrial::analysis
