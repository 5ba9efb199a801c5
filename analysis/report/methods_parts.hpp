/// \file The paragraphs of a report's methods. Private to analysis/report.
#pragma once

#include "analysis/report/methods.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// Builds a paragraph. Sources are cited in the text, as "(Holm, 1979)", and collected for the list
/// of references.
class Paragraph {
 public:
  /// \param sentence  with its full stop; may be empty
  /// \param sources  cited before the full stop
  void add(std::string_view sentence, const std::vector<Source>& sources = {});
  void add(const Sentences& sentences);

  [[nodiscard]] const CitedText& cited() const noexcept { return cited_; }

 private:
  CitedText cited_;
};

inline constexpr std::size_t kHashDigits = 16;  ///< digits shown of a hash

/// "Brown et al., 2001"
[[nodiscard]] std::string author_and_year(Source source);

/// "exploration from landing: at least 5 s; contact: at least 5 s"
[[nodiscard]] std::string joined_fields(
    const std::vector<std::pair<std::string, std::string>>& fields);

/// A text of a study file, as one line in quotation marks.
[[nodiscard]] std::string quoted_statement(const std::string& text);

[[nodiscard]] CitedText participants_paragraph(const StudyHead& head, const Outcomes& outcomes);
[[nodiscard]] CitedText stimuli_paragraph(const StudyHead& head, const Outcomes& outcomes,
                                          const RecordedStudy& recorded);
[[nodiscard]] CitedText procedure_paragraph(const StudyHead& head, const Outcomes& outcomes,
                                            const ProtocolMethods& protocol);
[[nodiscard]] CitedText analysis_paragraph(const Outcomes& outcomes, const RecordedStudy& recorded,
                                           const ProtocolMethods& protocol);

/// The records of counted sessions.
[[nodiscard]] std::vector<const SessionRecord*> counted_records(const StudyHead& head,
                                                                const Outcomes& outcomes);

}  // namespace touchtrial::analysis
