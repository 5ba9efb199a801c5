/// \file A folder that appears whole or not at all. Private to stimuli/import.
#pragma once

#include <filesystem>

namespace touchtrial::stimuli {

/// Files are written into a draft beside the target; `put_in_place` renames it. Until `keep` is
/// called, the destructor brings everything back to what it was.
class DraftFolder {
 public:
  /// \throws FileError if the draft cannot be made
  explicit DraftFolder(std::filesystem::path target);
  ~DraftFolder();
  DraftFolder(const DraftFolder&) = delete;
  DraftFolder& operator=(const DraftFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return draft_; }

  /// Moves what is at the target aside, and the draft there. \throws FileError
  void put_in_place();

  /// Nothing can go wrong any more: what was at the target before is removed.
  void keep() noexcept;

 private:
  std::filesystem::path target_;
  std::filesystem::path draft_;
  std::filesystem::path earlier_;  ///< what was at the target; empty: nothing, or not moved
  bool in_place_ = false;
  bool kept_ = false;
};

}  // namespace touchtrial::stimuli
