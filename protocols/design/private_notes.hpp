/// \file What the program found out about a study and may look up instead of computing it again.
#pragma once

#include "core/cipher.hpp"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::design {

/// Notes that were not written for so long are removed when others are: their pictures or their
/// study may be gone.
inline constexpr std::chrono::days kKeptNotes{90};

/// A file of notes on one subject, sealed under the study's master secret: who lacks the study's
/// key learns neither whose notes they are nor what they say, and can forge none. Notes of another
/// build of the program do not open. What is missing, damaged or cannot be written is no error: it
/// is found out anew. Not thread-safe; two processes may use the same notes.
class PrivateNotes {
 public:
  /// \param folder  that of the user's cache (engine::user_cache_folder); empty: keeps nothing
  /// \param subject  distinguishes the notes of one study
  PrivateNotes(const std::filesystem::path& folder, const SecretKey& master,
               std::string_view subject);

  /// \return the text that was last kept, or nothing
  [[nodiscard]] std::optional<std::string> read() const;
  /// Also removes notes of any study from the folder that are older than kKeptNotes.
  void keep(std::string_view text) const;

 private:
  SecretKey key_;
  std::string context_;         ///< subject and build
  std::filesystem::path file_;  ///< empty: keeps nothing
};

}  // namespace touchtrial::design
