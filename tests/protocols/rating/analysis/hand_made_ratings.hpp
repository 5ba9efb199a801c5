/// \file Outcomes of a rating study for which a test gives every trial.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/page/document.hpp"

#include <string>
#include <vector>

namespace touchtrial {

/// The study file's "rating" with the scale "fit", a line.
inline constexpr const char* kOneScale =
    R"({"scales": [{"id": "fit", "text": {"en": "Do they fit?"},
    "low": {"en": "not at all"}, "high": {"en": "perfectly"}}]})";
/// The same with the scale "rough" of seven points beside it.
inline constexpr const char* kTwoScales =
    R"({"scales": [{"id": "fit", "text": {"en": "Do they fit?"},
    "low": {"en": "not at all"}, "high": {"en": "perfectly"}},
    {"id": "rough", "text": {"en": "How rough?"}, "low": {"en": "smooth"}, "high": {"en": "rough"},
     "points": 7}]})";

/// The sentences of a document, a line each.
[[nodiscard]] std::string said_in(const analysis::Document& document);

/// Sessions are of P1, P2 and so on.
class HandMadeRatings {
 public:
  /// \param section  the study file's "rating"
  explicit HandMadeRatings(const std::string& section = kOneScale,
                           const std::vector<std::string>& methods = {"adaptive", "fixed"},
                           const std::vector<std::string>& classes = {"bark", "cloth"});

  void session(bool counted = true);
  /// A scored trial of a session.
  /// \param values  on each scale
  void rated(int session, int texture_class, int method, const std::vector<double>& values);
  /// A catch trial.
  void caught(int session, const std::vector<double>& values);
  /// A scored trial in which the time ran out.
  void missed(int session, int texture_class, int method);

  analysis::Outcomes outcomes;
};

}  // namespace touchtrial
