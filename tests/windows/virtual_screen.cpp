#include "windows/virtual_screen.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <X11/Xlib.h>
#include <X11/keysym.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xcb/xcb.h>
#include <xcb/xtest.h>

namespace touchtrial {
namespace {

struct Freed {
  void operator()(void* memory) const noexcept { std::free(memory); }
};
template <typename Reply>
using Owned = std::unique_ptr<Reply, Freed>;

template <typename Reply>
Owned<Reply> owned(Reply* reply) {
  return Owned<Reply>(reply);
}

[[noreturn]] void become_server(int number_to, const std::string& size) {
  // A test that is killed leaves no server behind.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const std::string descriptor = std::to_string(number_to);
  const std::string screen = size + "x24";
  ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(),
           "-nolisten", "tcp", "-noreset", "-r", static_cast<char*>(nullptr));
  ::_exit(127);
}

/// The number that the server writes once it accepts clients; "" if it ended instead.
std::string display_number(int from) {
  std::string number;
  for (char c = 0; ::read(from, &c, 1) == 1 && c != '\n';) number += c;
  return number;
}

/// The keys of a letter.
struct Stroke {
  std::uint8_t key = 0;
  bool with_shift = false;
};

}  // namespace

/// A client of the server. It searches for windows each time; a request to a window that has closed
/// returns an error, which does not end a test.
class VirtualScreen::Client {
 public:
  Client() : connection_(xcb_connect(nullptr, nullptr)) {
    if (xcb_connection_has_error(connection_) != 0) {
      xcb_disconnect(connection_);
      throw std::runtime_error("the X server takes no client");
    }
    root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
    protocols_ = atom("WM_PROTOCOLS");
    ping_ = atom("_NET_WM_PING");
    strokes_ = strokes();
    // Windows that close, and answers to pings.
    const std::uint32_t events = XCB_EVENT_MASK_SUBSTRUCTURE_NOTIFY;
    insist(xcb_change_window_attributes_checked(connection_, root_, XCB_CW_EVENT_MASK, &events),
           "events of the screen");
  }
  ~Client() { xcb_disconnect(connection_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void fake(std::uint8_t type, std::uint8_t detail, int x = 0, int y = 0) {
    insist(
        xcb_test_fake_input_checked(connection_, type, detail, XCB_CURRENT_TIME, root_,
                                    static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), 0),
        "input");
  }

  void type(const std::string& name) {
    const Stroke stroke = stroke_of(XStringToKeysym(name.c_str()), name);
    const std::uint8_t shift = stroke_of(XK_Shift_L, "Shift").key;
    if (stroke.with_shift) fake(XCB_KEY_PRESS, shift);
    fake(XCB_KEY_PRESS, stroke.key);
    fake(XCB_KEY_RELEASE, stroke.key);
    if (stroke.with_shift) fake(XCB_KEY_RELEASE, shift);
  }

  /// No window manager puts frames around windows: they are the screen's children.
  [[nodiscard]] std::optional<xcb_window_t> find(const std::string& title) {
    const auto tree =
        owned(xcb_query_tree_reply(connection_, xcb_query_tree(connection_, root_), nullptr));
    if (!tree) throw std::runtime_error("the X server tells no windows");
    const xcb_window_t* const windows = xcb_query_tree_children(tree.get());
    for (int i = 0; i < xcb_query_tree_children_length(tree.get()); ++i) {
      if (title_of(windows[i]) == title) return windows[i];
    }
    return std::nullopt;
  }

  [[nodiscard]] xcb_window_t window(const std::string& title) {
    const auto found = find(title);
    if (!found) throw std::runtime_error("there is no window '" + title + "'");
    return *found;
  }

  [[nodiscard]] xcb_window_t root() const noexcept { return root_; }

  void focus(xcb_window_t window) {
    insist(
        xcb_set_input_focus_checked(connection_, XCB_INPUT_FOCUS_PARENT, window, XCB_CURRENT_TIME),
        "the focus");
  }

  /// Sends a window manager's ping to a program: because it takes events in order, it has taken all
  /// earlier events when it answers.
  /// \return false if the window closed
  [[nodiscard]] bool ping(xcb_window_t window) {
    while (owned(xcb_poll_for_event(connection_))) {
    }
    xcb_client_message_event_t question{};
    question.response_type = XCB_CLIENT_MESSAGE;
    question.format = 32;
    question.window = window;
    question.type = protocols_;
    question.data.data32[0] = ping_;
    question.data.data32[1] = ++pings_;
    question.data.data32[2] = window;
    const auto sent = xcb_send_event_checked(connection_, 0, window, XCB_EVENT_MASK_NO_EVENT,
                                             reinterpret_cast<const char*>(&question));
    if (owned(xcb_request_check(connection_, sent))) return false;
    while (const auto event = owned(xcb_wait_for_event(connection_))) {
      if (is_answer(*event)) return true;
      if (is_end_of(window, *event)) return false;
    }
    throw std::runtime_error("the X server has ended");
  }

 private:
  void insist(xcb_void_cookie_t request, const std::string& what) {
    const auto error = owned(xcb_request_check(connection_, request));
    if (!error && xcb_connection_has_error(connection_) == 0) return;
    throw std::runtime_error("the X server refuses " + what + ", error " +
                             (error ? std::to_string(error->error_code) : "of the connection"));
  }

  [[nodiscard]] xcb_atom_t atom(const std::string& name) {
    const auto cookie =
        xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(name.size()), name.c_str());
    const auto reply = owned(xcb_intern_atom_reply(connection_, cookie, nullptr));
    if (!reply) throw std::runtime_error("the X server has no atom " + name);
    return reply->atom;
  }

  /// The keys of every symbol on the keyboard, without the shift key if possible.
  [[nodiscard]] std::map<xcb_keysym_t, Stroke> strokes() {
    const xcb_setup_t* const setup = xcb_get_setup(connection_);
    const xcb_keycode_t first = setup->min_keycode;
    const auto cookie = xcb_get_keyboard_mapping(
        connection_, first, static_cast<std::uint8_t>(setup->max_keycode - first + 1));
    const auto keyboard = owned(xcb_get_keyboard_mapping_reply(connection_, cookie, nullptr));
    if (!keyboard) throw std::runtime_error("the X server has no keyboard");
    const xcb_keysym_t* const symbols = xcb_get_keyboard_mapping_keysyms(keyboard.get());
    const int each = keyboard->keysyms_per_keycode;
    const int keys = xcb_get_keyboard_mapping_keysyms_length(keyboard.get()) / each;
    std::map<xcb_keysym_t, Stroke> strokes;
    for (int level = 0; level < std::min(each, 2); ++level) {
      for (int key = 0; key < keys; ++key) {
        strokes.try_emplace(symbols[key * each + level],
                            Stroke{static_cast<std::uint8_t>(first + key), level == 1});
      }
    }
    return strokes;
  }

  [[nodiscard]] Stroke stroke_of(KeySym symbol, const std::string& name) const {
    const auto found = strokes_.find(static_cast<xcb_keysym_t>(symbol));
    if (symbol == NoSymbol || found == strokes_.end()) {
      throw std::runtime_error("the keyboard has no key '" + name + "'");
    }
    return found->second;
  }

  [[nodiscard]] std::string title_of(xcb_window_t window) {
    constexpr std::uint32_t kLongest = 256;
    const auto cookie = xcb_get_property(connection_, 0, window, XCB_ATOM_WM_NAME,
                                         XCB_GET_PROPERTY_TYPE_ANY, 0, kLongest);
    const auto title = owned(xcb_get_property_reply(connection_, cookie, nullptr));
    if (!title) return "";
    return {static_cast<const char*>(xcb_get_property_value(title.get())),
            static_cast<std::size_t>(xcb_get_property_value_length(title.get()))};
  }

  /// The ping, which the program returns to the screen.
  [[nodiscard]] bool is_answer(const xcb_generic_event_t& event) const {
    constexpr unsigned kSent = 0x80U;
    if ((event.response_type & ~kSent) != XCB_CLIENT_MESSAGE) return false;
    const auto& message = reinterpret_cast<const xcb_client_message_event_t&>(event);
    return message.type == protocols_ && message.data.data32[0] == ping_ &&
           message.data.data32[1] == pings_;
  }

  [[nodiscard]] static bool is_end_of(xcb_window_t window, const xcb_generic_event_t& event) {
    if (event.response_type != XCB_DESTROY_NOTIFY) return false;
    return reinterpret_cast<const xcb_destroy_notify_event_t&>(event).window == window;
  }

  xcb_connection_t* connection_;
  xcb_window_t root_ = XCB_NONE;
  xcb_atom_t protocols_ = XCB_NONE;
  xcb_atom_t ping_ = XCB_NONE;
  std::map<xcb_keysym_t, Stroke> strokes_;
  std::uint32_t pings_ = 0;
};

std::unique_ptr<VirtualScreen> VirtualScreen::open(const std::string& size) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
  std::unique_ptr<VirtualScreen> screen(new VirtualScreen);
  screen->server_ = ::fork();
  if (screen->server_ == 0) become_server(pipe[1], size);
  ::close(pipe[1]);
  const std::string number = display_number(pipe[0]);
  ::close(pipe[0]);
  if (number.empty()) {
    throw std::runtime_error("Xvfb does not start; run scripts/install-dependencies tests");
  }
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  ::unsetenv("WAYLAND_DISPLAY");
  screen->client_ = std::make_unique<Client>();
  return screen;
}

VirtualScreen::~VirtualScreen() {
  client_.reset();
  if (server_ <= 0) return;
  ::kill(server_, SIGTERM);
  ::waitpid(server_, nullptr, 0);
  ::unsetenv("DISPLAY");
}

void VirtualScreen::move_pointer(int x, int y) const {
  client_->fake(XCB_MOTION_NOTIFY, 0, x, y);
}

void VirtualScreen::press() const {
  client_->fake(XCB_BUTTON_PRESS, XCB_BUTTON_INDEX_1);
}

void VirtualScreen::release() const {
  client_->fake(XCB_BUTTON_RELEASE, XCB_BUTTON_INDEX_1);
}

void VirtualScreen::type(const std::string& keys) const {
  std::istringstream names(keys);
  for (std::string name; names >> name;) client_->type(name);
}

void VirtualScreen::focus_window(const std::string& title) const {
  client_->focus(client_->window(title));
}

void VirtualScreen::take_focus() const {
  client_->focus(client_->root());
}

bool VirtualScreen::wait_until_heard(const std::string& title) const {
  const auto window = client_->find(title);
  return window && client_->ping(*window);
}

}  // namespace touchtrial
