/// \file The experimenter's window without a screen: its panel is drawn into memory, and clicked.
#pragma once

#include "app/windows/experimenter/console_panel.hpp"
#include "app/windows/experimenter/experimenter_desk.hpp"

struct ImGuiContext;

namespace touchtrial {

class DrawnConsole {
 public:
  /// \param desk  must outlive this
  explicit DrawnConsole(app::ExperimenterDesk& desk);
  ~DrawnConsole();
  DrawnConsole(const DrawnConsole&) = delete;
  DrawnConsole& operator=(const DrawnConsole&) = delete;

  /// Presses and releases the button of an action, wherever the panel has drawn it.
  void click(app::ExperimenterAction::Kind what);

 private:
  void draw(bool is_down);

  ImGuiContext* context_;
  app::ConsolePanel panel_;
  Vec2 at_{-1.0, -1.0};
};

}  // namespace touchtrial
