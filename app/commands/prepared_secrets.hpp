/// \file The key and the stations' files of a study that is prepared.
#pragma once

#include "core/bytes.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::app {

/// Reads the study's key, or makes it, and writes all files of secrets as drafts beside their
/// places. `publish` puts them there; without it nothing has changed. Use it while the pack is
/// locked.
class PreparedSecrets {
 public:
  /// An earlier key keeps its secrets, so that codes and fields stay valid. Removes the drafts of a
  /// run that was killed.
  /// \param passphrase  whether to protect a key that is in clear, or new, by one that is asked for
  /// \throws UsageError if the key is a simulated study's, or another study's
  /// \throws FileError if the key is gone whose station's file or pack is there, or a file cannot
  ///   be read or written
  PreparedSecrets(const study::Study& study, const study::PackPlace& place, bool passphrase);

  [[nodiscard]] const study::StudyKey& key() const noexcept { return key_; }
  /// Whether no file has had the key yet.
  [[nodiscard]] bool is_new() const noexcept { return before_.empty(); }

  /// Each file replaces the one before it, the key first: no station's file is ever there without
  /// the key that opens what it seals.
  /// \throws FileError if another program has written the key meanwhile, or the system refuses
  void publish();

 private:
  struct Draft {
    std::filesystem::path file;
    std::filesystem::path place;
  };
  /// Removes those that were not put into their places.
  struct Drafts {
    Drafts() = default;
    ~Drafts();
    Drafts(const Drafts&) = delete;
    Drafts& operator=(const Drafts&) = delete;

    std::vector<Draft> in_order;  ///< in which they are put into their places
  };

  void draft_secrets(bool passphrase);
  std::filesystem::path draft_for(const std::filesystem::path& place);

  study::PackPlace place_;
  Bytes before_;  ///< of the key's file; empty: there was none
  std::optional<study::StudyKey> earlier_;
  study::StudyKey key_;
  Drafts drafts_;
};

}  // namespace touchtrial::app
