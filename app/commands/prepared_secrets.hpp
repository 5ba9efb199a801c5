/// \file The key and the stations' files of a study in preparation.
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

/// Reads or creates the study's key, and writes all files of secrets as drafts beside their paths.
/// `publish` renames them; without it nothing changes. Use it while the pack is locked.
class PreparedSecrets {
 public:
  /// Reuses the secrets of a previous key, so that codes and fields stay valid. Removes
  /// the drafts of a killed run.
  /// \param passphrase  whether to ask for a passphrase that protects a new or unprotected key
  /// \throws UsageError if the key is a simulated study's, or another study's
  /// \throws FileError if a station's file or pack exists but its key is missing, or a file cannot be
  ///   read or written
  PreparedSecrets(const study::Study& study, const study::PackPlace& place, bool passphrase);

  [[nodiscard]] const study::StudyKey& key() const noexcept { return key_; }
  /// Whether the key is new and not yet in any file.
  [[nodiscard]] bool is_new() const noexcept { return previous_bytes_.empty(); }

  /// Replaces the files, the key first, so that no station's file exists without the key that
  /// decrypts its data.
  /// \throws FileError if another program has written the key in the meantime, or the system refuses
  void publish();

 private:
  struct Draft {
    std::filesystem::path file;
    std::filesystem::path target;
  };
  /// Removes drafts that were not renamed.
  struct Drafts {
    Drafts() = default;
    ~Drafts();
    Drafts(const Drafts&) = delete;
    Drafts& operator=(const Drafts&) = delete;

    std::vector<Draft> list;  ///< in the order of renaming
  };

  void draft_secrets(bool passphrase);
  std::filesystem::path draft_for(const std::filesystem::path& path);

  study::PackPlace place_;
  Bytes previous_bytes_;  ///< content of the key's file; empty: no such file
  std::optional<study::StudyKey> previous_key_;
  study::StudyKey key_;
  Drafts drafts_;
};

}  // namespace touchtrial::app
