// preview: shows the participant's screens of a study, without a session.
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
        first_index_(index_of(arguments.screen)),
        window_(options()) {}

  int show() {
    run_beside(window_, [this] { arguments_.png.empty() ? browse() : draw(); });
    return 0;
  }

 private:
  /// The designer's request.
  enum class Request { none, back, next, answered, end };

  [[nodiscard]] std::size_t index_of(const std::string& name) const {
    if (name.empty()) return 0;
    const auto match = std::ranges::find(screens_, name, &PreviewScreen::name);
    if (match != screens_.end()) return static_cast<std::size_t>(match - screens_.begin());
    std::vector<std::string_view> names;
    for (const PreviewScreen& screen : screens_) names.push_back(screen.name);
    const auto nearest = nearest_name(name, names);
    throw UsageError(one_line("preview: the study has no screen '" + name + "'; " +
                              (nearest ? "did you mean " + std::string(*nearest) + "? " : "") +
                              "the screens are " + listed(names, " and ")));
  }

  ParticipantWindowOptions options() {
    ParticipantWindowOptions result = window_options(arguments_.window, study_);
    if (arguments_.mouse) result.pointer = &pointer_;
    if (arguments_.console) result.console = &console_;
    result.min_touch = {0.0, 0.0};  // there is no texture
    result.interval_pause = std::chrono::hours(24);
    result.turn_page = [this](int pages) {
      request_ = pages == 0 ? Request::end : pages < 0 ? Request::back : Request::next;
    };
    const GreyImage& picture = result.pictures.at(study_.classes.front().label);
    plane_ = {study_.rendering.pitch_mm, picture.height(), picture.width()};
    return result;
  }

  void require_shown() {
    if (!window_.wait_until_shown(kPreviewTimeout)) {
      throw DeviceError("preview: the window shows nothing; check the graphics driver");
    }
  }

  /// Shows a screen as it appears after an exploration, so that nothing of the previous screen
  /// remains.
  void present(const PreviewScreen& screen) {
    session::SessionStatus status;
    status.participant = "P07";
    status.stage = screen.name;
    status.device = "preview";
    console_.show(status);
    window_.see_pictures(preview_labels(study_, screen));
    static_cast<void>(window_.show_step(session::ReadyStep{1, 1, screen.practice}));
    if (screen.interval) static_cast<void>(window_.show_step(*screen.interval));
    window_.show_exploring(plane_);
    if (!screen.step) return;
    static_cast<void>(window_.show_step(*screen.step));
    for (InputEvent key : screen.keys) {
      require_shown();
      key.at = std::chrono::steady_clock::now();
      window_.inject(key);
    }
  }

  void draw() {
    const bool is_single = !arguments_.screen.empty();
    const std::size_t end = is_single ? first_index_ + 1 : screens_.size();
    const auto file_of = [&](const PreviewScreen& screen) {
      return is_single ? arguments_.png : arguments_.png / (screen.name + ".png");
    };
    const fs::path console =
        (is_single ? arguments_.png.parent_path() : arguments_.png) / "console.png";
    for (std::size_t i = first_index_; i < end; ++i) require_output_path(file_of(screens_[i]));
    if (arguments_.console) require_output_path(console);
    if (!is_single) make_folder(arguments_.png);
    for (std::size_t i = first_index_; i < end; ++i) {
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
    print("Page Down: next screen, Page Up: previous screen, Escape: end\n");
    for (std::size_t index = first_index_;;) {
      present(screens_[index]);
      print(fmt::format("{} ({} of {})\n", screens_[index].name, index + 1, screens_.size()));
      const Request request = wait_for_request(screens_[index]);
      if (request == Request::end) return;
      if (request == Request::back) index -= index > 0 ? 1 : 0;
      if (request == Request::next) index += index + 1 < screens_.size() ? 1 : 0;
      if (request != Request::answered) continue;
      index = next_step_index(index);
      if (index == screens_.size()) return;
    }
  }

  /// The index of the screen after all pages of a step.
  [[nodiscard]] std::size_t next_step_index(std::size_t index) const {
    const auto& step = screens_[index].step;
    do ++index;
    while (step && index < screens_.size() && screens_[index].step &&
           is_same_step(*step, *screens_[index].step));
    return index;
  }

  Request wait_for_request(const PreviewScreen& screen) {
    for (;;) {
      if (window_.end_reason()) return Request::end;
      if (const Request request = request_.exchange(Request::none); request != Request::none)
        return request;
      if (screen.step) {
        if (window_.show_step(*screen.step)) return Request::answered;
        continue;
      }
      device::ServoControl servo;
      window_.while_exploring(servo);
      if (servo.finish_requested() || servo.comfort_stop_requested()) return Request::answered;
      std::this_thread::sleep_for(kPreviewPause);
    }
  }

  const PreviewArguments& arguments_;
  study::Study study_;
  session::SessionTexts texts_;
  std::vector<PreviewScreen> screens_;
  std::size_t first_index_;
  PlaneGeometry plane_;
  device::PointerExchange pointer_;
  std::atomic<Request> request_{Request::none};
  ExperimenterDesk console_{false};  ///< its requests are ignored
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
