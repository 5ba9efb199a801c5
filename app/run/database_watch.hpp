/// \file What other programs do to a session's database while the session runs: they lock it,
/// replace it or remove it.
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

/// Passes a session's events on, and waits as long as another program has the database locked.
class PatientSink final : public record::EventSink {
 public:
  /// Called about every two seconds while an event waits, on the session's thread.
  /// \return whether to go on waiting
  using Waiting = std::function<bool(const std::string& why)>;

  explicit PatientSink(std::unique_ptr<record::EventSink> inner) : inner_(std::move(inner)) {}
  /// Without it, nothing waits.
  void set_waiting(Waiting waiting) { waiting_ = std::move(waiting); }
  /// How long an event waited at most since the last call; empty: less than anybody notices.
  [[nodiscard]] std::optional<std::chrono::steady_clock::duration> take_waited() {
    return std::exchange(waited_, std::nullopt);
  }

  void accept(const record::Event& event, const std::optional<record::SealedTrace>& trace) override;
  void accept_together(std::span<const record::RecordedEvent> events) override;

 private:
  void patiently(const std::function<void()>& store);

  std::unique_ptr<record::EventSink> inner_;
  Waiting waiting_;
  std::optional<std::chrono::steady_clock::duration> waited_;
};

/// Looks whether the files at a database's path are still those that were opened.
class DatabaseWatch {
 public:
  /// \param database  of an open store, which has made its log
  explicit DatabaseWatch(std::filesystem::path database);

  /// Looks at the disk, at most once a second.
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

/// Reads the end of a session back by the database's path.
/// \param store  that recorded the session
/// \return whether the path holds the session as it was recorded
[[nodiscard]] bool is_on_disk(const std::filesystem::path& database, int session,
                              const record::StudyStore& store);

/// Saves what an open store holds to a free name beside the database.
/// \return what was done, for a person
[[nodiscard]] std::string rescue(const std::filesystem::path& database,
                                 const record::StudyStore& store);

}  // namespace touchtrial::app
