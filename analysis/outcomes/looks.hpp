/// \file The looks at outcomes: every unblinding on the file's chain.
#pragma once

#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

enum class LookKind {
  final,         ///< after the study was closed
  registered,    ///< at the registered question only, at a registered number of participants
  unregistered,  ///< any other interim look
  person,        ///< at one participant's outcomes
};

/// "final", "registered", "unregistered", "one participant"
[[nodiscard]] std::string name_of(LookKind kind);

struct Look {
  std::chrono::nanoseconds at{};  ///< UTC since 1970
  int participants = 0;           ///< participants with counting sessions at that time
  std::string reason;
  LookKind kind = LookKind::final;
  std::string participant{};  ///< for LookKind::person
  int station = 0;  ///< in a collected study, the station that looked, from 1; 0: the whole study

  /// For LookKind::person: several participants were viewed before the study was closed, which
  /// shows interim results.
  bool is_one_of_several = false;

  /// Whether this look was unregistered and could have influenced when collection ended. A look at
  /// one participant reveals too little for that.
  [[nodiscard]] bool is_unregistered() const noexcept {
    return kind == LookKind::unregistered || is_one_of_several;
  }
};

/// The looks at a study's outcomes, and the sessions removed after a look.
struct LookRecord {
  std::vector<Look> looks;            ///< in the order of the chain; looks at stations come first
  std::set<int> excluded_afterwards;  ///< sessions excluded after a look at their outcomes
  std::set<int> replaced_afterwards;  ///< sessions replaced after a look
  std::set<int> erased_afterwards;    ///< sessions erased at the participant's request after a look
  int participants = 0;               ///< participants with counting sessions today
  bool may_look = false;              ///< an interim look now would be registered
};

/// Reads the looks from the file's chain and from collected stations' chains.
/// \param key  lists the registered looks. A study of several stations cannot have any, because a
///   look at a merged file is lost in the next merge
/// \throws StoreError if a body cannot be read
[[nodiscard]] LookRecord look_record(const record::StudyStore& store, const study::StudyKey& key);

}  // namespace touchtrial::analysis
