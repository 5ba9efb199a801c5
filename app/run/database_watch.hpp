/// \file Detects other programs that lock, replace or remove a session's database while the session
///   runs.
#pragma once

#include "record/session_recorder.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace touchtrial::app {

/// Forwards a session's events, and waits while another program locks the database.
class PatientSink final : public record::EventSink {
 public:
  /// Called about every two seconds while an event waits, on the session's thread.
  /// \return whether to continue waiting
  using WaitCallback = std::function<bool(const std::string& reason)>;

  explicit PatientSink(std::unique_ptr<record::EventSink> inner) : inner_(std::move(inner)) {}
  /// Sets the function to call; until then, events do not wait.
  void set_wait_callback(WaitCallback callback) { wait_callback_ = std::move(callback); }
  /// The longest wait of an event since the last call; empty: none was noticeable.
  [[nodiscard]] std::optional<std::chrono::steady_clock::duration> take_delay() {
    return std::exchange(longest_wait_, std::nullopt);
  }

  void accept(const record::Event& event, const std::optional<record::SealedTrace>& trace) override;
  void accept_together(std::span<const record::RecordedEvent> events) override;

 private:
  void retry_while_locked(const std::function<void()>& store);

  std::unique_ptr<record::EventSink> inner_;
  WaitCallback wait_callback_;
  std::optional<std::chrono::steady_clock::duration> longest_wait_;
};

/// Checks whether the files at a database's path are still those that were opened.
class DatabaseWatch {
 public:
  /// \param database  the file of an open store with a log
  explicit DatabaseWatch(std::filesystem::path database);

  /// Checks the disk, at most once a second.
  /// \return the problem, for instance "study.db was replaced by another file while the session
  ///   ran"; empty if there is none
  [[nodiscard]] std::string problem();

 private:
  struct File {
    std::filesystem::path path;
    std::optional<std::pair<unsigned long, unsigned long>> id;  ///< device and inode
  };

  std::filesystem::path database_;
  File file_;
  File log_;
  std::string problem_;
  std::chrono::steady_clock::time_point checked_at_{};
};

/// Reads the end of a session back from the database's path.
/// \param store  the store that recorded the session
/// \return whether the file at the path contains the session as recorded
[[nodiscard]] bool is_on_disk(const std::filesystem::path& database, int session,
                              const record::StudyStore& store);

/// Saves the content of an open store beside the database, under a free name.
/// \return a message for the user about the copy
[[nodiscard]] std::string save_copy(const std::filesystem::path& database,
                                    const record::StudyStore& store);

}  // namespace touchtrial::app
