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

/// Passes on a session's events, and waits while another program locks the database.
class PatientSink final : public record::EventSink {
 public:
  /// Called about every two seconds while an event waits, on the session's thread.
  /// \return whether to continue waiting
  using Waiting = std::function<bool(const std::string& why)>;

  explicit PatientSink(std::unique_ptr<record::EventSink> inner) : inner_(std::move(inner)) {}
  /// Without it, events do not wait.
  void set_waiting(Waiting waiting) { waiting_ = std::move(waiting); }
  /// The longest wait of an event since the last call; empty: not noticeable.
  [[nodiscard]] std::optional<std::chrono::steady_clock::duration> take_delay() {
    return std::exchange(waited_, std::nullopt);
  }

  void accept(const record::Event& event, const std::optional<record::SealedTrace>& trace) override;
  void accept_together(std::span<const record::RecordedEvent> events) override;

 private:
  void retry_while_locked(const std::function<void()>& store);

  std::unique_ptr<record::EventSink> inner_;
  Waiting waiting_;
  std::optional<std::chrono::steady_clock::duration> waited_;
};

/// Checks whether the files at a database's path are still the opened ones.
class DatabaseWatch {
 public:
  /// \param database  of an open store with a log
  explicit DatabaseWatch(std::filesystem::path database);

  /// Checks the disk, at most once a second.
  /// \return what happened, for instance "study.db was replaced by another file while the session
  ///   ran"; empty: nothing
  [[nodiscard]] std::string trouble();

 private:
  struct File {
    std::filesystem::path path;
    std::optional<std::pair<unsigned long, unsigned long>> id;  ///< device and inode
  };

  std::filesystem::path database_;
  File file_;
  File log_;
  std::string trouble_;
  std::chrono::steady_clock::time_point looked_{};
};

/// Reads back the end of a session by the database's path.
/// \param store  the one that recorded the session
/// \return whether the file at the path holds the session as recorded
[[nodiscard]] bool is_on_disk(const std::filesystem::path& database, int session,
                              const record::StudyStore& store);

/// Saves the content of an open store to a free name beside the database.
/// \return what was done, for a person
[[nodiscard]] std::string save_copy(const std::filesystem::path& database,
                                    const record::StudyStore& store);

}  // namespace touchtrial::app
