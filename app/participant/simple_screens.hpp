/// \file Screens with something to read and one button.
#pragma once

#include "app/participant/page_layout.hpp"
#include "app/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// A card, and at most one button.
class NoteScreen final : public Screen {
 public:
  struct Content {
    Progress progress;
    std::string title;
    std::string body;
    std::string note;
    std::string button;  ///< empty: the session goes on by itself
  };
  explicit NoteScreen(Content content) : content_(std::move(content)) {}

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }

  Content content_;
};

/// Pages that are turned in both directions; the last one's button replies.
class PagesScreen final : public Screen {
 public:
  PagesScreen(std::vector<std::string> pages, const Words& words);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }

  std::vector<std::string> pages_;
  const Words& words_;
  std::size_t page_ = 0;
};

/// Nothing but the ground.
class BlankScreen final : public Screen {
 private:
  void paint(Canvas& /*canvas*/) override {}
  [[nodiscard]] std::optional<session::StepReply> activate(int /*id*/, Time /*at*/) override {
    return std::nullopt;
  }
};

}  // namespace touchtrial::app
