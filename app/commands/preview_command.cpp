// preview: the participant's screens of a study, without a session.
#include "app/commands/commands.hpp"
#include "app/run/run_session.hpp"
#include "app/terminal/console.hpp"
#include "app/texts/study_texts.hpp"
#include "app/windows/experimenter/experimenter_desk.hpp"
#include "app/windows/participant/preview_screens.hpp"
#include "app/windows/participant/screen.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"
#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct PreviewArguments {
  fs::path study;
  std::string screen;  ///< empty: the first, or all with `png`
  fs::path png;        ///< empty: a window to look at
  bool mouse = false;
  bool console = false;
  RunOptions window;
};

constexpr std::chrono::milliseconds kPreviewPause{10};
/// Only a hanging window exceeds this.
constexpr std::chrono::minutes kPreviewTimeout{5};

class Preview {
 public:
  explicit Preview(const PreviewArguments& arguments)
      : arguments_(arguments),
        study_(study::load_study(arguments.study)),
        texts_(session_texts(study_)),
        screens_(preview_screens(study_, texts_)),
        first_(place_of(arguments.screen)),
        window_(options()) {}

  int show() {
    run_beside(window_, [this] { arguments_.png.empty() ? browse() : draw(); });
    return 0;
  }

 private:
  /// The next screen that the designer requests.
  enum class Turn { none, back, next, answered, end };

  [[nodiscard]] std::size_t place_of(const std::string& name) const {
    if (name.empty()) return 0;
    const auto found = std::ranges::find(screens_, name, &PreviewScreen::name);
    if (found != screens_.end()) return static_cast<std::size_t>(found - screens_.begin());
    std::vector<std::string_view> names;
    for (const PreviewScreen& one : screens_) names.push_back(one.name);
    const auto nearest = nearest_name(name, names);
    throw UsageError(one_line("preview: the study has no screen '" + name + "'; " +
                              (nearest ? "did you mean " + std::string(*nearest) + "? " : "") +
                              "there are " + listed(names, " and ")));
  }

  ParticipantWindowOptions options() {
    ParticipantWindowOptions wanted = window_options(arguments_.window, study_);
    if (arguments_.mouse) wanted.pointer = &pointer_;
    if (arguments_.console) wanted.console = &console_;
    wanted.min_touch = {0.0, 0.0};  // nothing is felt
    wanted.interval_pause = std::chrono::hours(24);
    wanted.turn = [this](int pages) {
      turn_ = pages == 0 ? Turn::end : pages < 0 ? Turn::back : Turn::next;
    };
    const GreyImage& picture = wanted.pictures.at(study_.classes.front().label);
    plane_ = {study_.rendering.pitch_mm, picture.height(), picture.width()};
    return wanted;
  }

  void require_shown() {
    if (!window_.wait_until_shown(kPreviewTimeout)) {
      throw DeviceError("preview: the window shows nothing; check the graphics driver");
    }
  }

  /// Shows a screen as after a plane, so that nothing of the previous screen remains.
  void present(const PreviewScreen& screen) {
    session::SessionStatus status;
    status.participant = "P07";
    status.stage = screen.name;
    status.device = "preview";
    console_.show(status);
    window_.see_pictures(preview_labels(study_, screen));
    static_cast<void>(window_.attend(session::ReadyStep{1, 1, screen.practice}));
    if (screen.interval) static_cast<void>(window_.attend(*screen.interval));
    window_.show_exploring(plane_);
    if (!screen.step) return;
    static_cast<void>(window_.attend(*screen.step));
    for (InputEvent key : screen.keys) {
      require_shown();
      key.at = std::chrono::steady_clock::now();
      window_.inject(key);
    }
  }

  void draw() {
    const bool is_one = !arguments_.screen.empty();
    const std::size_t end = is_one ? first_ + 1 : screens_.size();
    const auto file_of = [&](const PreviewScreen& screen) {
      return is_one ? arguments_.png : arguments_.png / (screen.name + ".png");
    };
    const fs::path console =
        (is_one ? arguments_.png.parent_path() : arguments_.png) / "console.png";
    for (std::size_t i = first_; i < end; ++i) require_output_place(file_of(screens_[i]));
    if (arguments_.console) require_output_place(console);
    if (!is_one) make_folder(arguments_.png);
    for (std::size_t i = first_; i < end; ++i) {
      present(screens_[i]);
      require_shown();
      write(file_of(screens_[i]), window_.picture());
    }
    if (arguments_.console) write(console, window_.console_picture());
  }

  static void write(const fs::path& file, const engine::ColourImage& picture) {
    write_output(file, engine::png_bytes(picture));
    print(file.string() + "\n");
  }

  void browse() {
    print("Page Down: next screen, Page Up: the one before, Escape: end\n");
    for (std::size_t at = first_;;) {
      present(screens_[at]);
      print(fmt::format("{} ({} of {})\n", screens_[at].name, at + 1, screens_.size()));
      const Turn turn = wait_for_turn(screens_[at]);
      if (turn == Turn::end) return;
      if (turn == Turn::back) at -= at > 0 ? 1 : 0;
      if (turn == Turn::next) at += at + 1 < screens_.size() ? 1 : 0;
      if (turn != Turn::answered) continue;
      at = after(at);
      if (at == screens_.size()) return;
    }
  }

  /// The screen that follows all pages of a step.
  [[nodiscard]] std::size_t after(std::size_t at) const {
    const auto& step = screens_[at].step;
    do ++at;
    while (step && at < screens_.size() && screens_[at].step &&
           is_same_step(*step, *screens_[at].step));
    return at;
  }

  Turn wait_for_turn(const PreviewScreen& screen) {
    for (;;) {
      if (window_.end_reason()) return Turn::end;
      if (const Turn turn = turn_.exchange(Turn::none); turn != Turn::none) return turn;
      if (screen.step) {
        if (window_.attend(*screen.step)) return Turn::answered;
        continue;
      }
      device::ServoControl servo;
      window_.exploring(servo);
      if (servo.finish_asked() || servo.comfort_stop_asked()) return Turn::answered;
      std::this_thread::sleep_for(kPreviewPause);
    }
  }

  const PreviewArguments& arguments_;
  study::Study study_;
  session::SessionTexts texts_;
  std::vector<PreviewScreen> screens_;
  std::size_t first_;
  PlaneGeometry plane_;
  device::PointerExchange pointer_;
  std::atomic<Turn> turn_{Turn::none};
  ExperimenterDesk console_{false};  ///< whose requests are ignored
  ParticipantWindow window_;
};

}  // namespace

void add_preview_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<PreviewArguments>();
  CLI::App* command = program.add_subcommand(
      "preview", "Show a study's screens as participants see them, without a session");
  add_study_argument(*command, arguments->study);
  command->add_option("--screen", arguments->screen,
                      "Name of a screen, for instance answer (default: the first)");
  command->add_option("--png", arguments->png,
                      "Write the screen to this PNG file, or without --screen every screen to this "
                      "folder");
  add_force_flag(*command);
  command->add_flag("--mouse", arguments->mouse, "Show the screens for the mouse as the device");
  command->add_flag(
      "--console", arguments->console,
      "Also show the experimenter's window; with --png, write it as console.png beside the others");
  arguments->window.window_px = {1280, 720};
  add_window_options(*command, arguments->window.monitor, arguments->window.window_px,
                     "Size WIDTHxHEIGHT of the window and of the pictures, pixels (default: "
                     "1280x720; with --monitor, the whole monitor)");
  command->callback([=, &action] {
    if (command->count("--monitor") > 0 && command->count("--window") == 0) {
      arguments->window.window_px.reset();
    }
    action = [=] { return Preview(*arguments).show(); };
  });
}

}  // namespace touchtrial::app
