#include "device/platform/dynamic_library.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <string_view>

namespace touchtrial {
namespace {

TEST_CASE("a missing library is named with the remedy, on one line") {
  const auto load = [] {
    device::DynamicLibrary("/nowhere/lib\nHD.so", device::Unload::when_closed, "do this");
  };
  CHECK_THROWS_AS(load(), DeviceError);
  CHECK_THROWS_WITH(load(),
                    names("/nowhere/lib HD.so") && holds_text("do this") && !holds_text("\n"));
}

TEST_CASE("a file that is not a library is refused with the linker's reason") {
  const auto content = GENERATE(std::string_view(""), std::string_view("no library"),
                                std::string_view("\x7f"
                                                 "ELF and nothing more"));
  const TempFolder folder;
  const auto file = folder.path() / "no-library.so";
  replace_file(file, content);
  CHECK_THROWS_WITH(device::DynamicLibrary(file, device::Unload::when_closed, "do this"),
                    names(file.string()) && holds_text("do this"));
  std::filesystem::remove(file);
}

TEST_CASE("an empty name is refused, and does not mean the program itself") {
  CHECK_THROWS_AS(device::DynamicLibrary("", device::Unload::when_closed, "do this"), DeviceError);
}

TEST_CASE("functions are found by name, and a missing one is named") {
  const device::DynamicLibrary library(TOUCHTRIAL_FAKE_HD, device::Unload::when_closed, "do this");
  CHECK(library.function<void()>("fake_hd_exports") != nullptr);
  void (*found)() = nullptr;
  library.find("fake_hd_exports", found);
  CHECK(found != nullptr);
  library.find_if_any("hdNoSuchThing", found);
  CHECK(found == nullptr);
  CHECK_THROWS_WITH(library.function<void()>("hdNoSuchThing"),
                    names("hdNoSuchThing") && holds_text("do this"));
}

TEST_CASE("a reference that no library has refuses a library, unless it is resolved as needed") {
  using device::Binding;
  using device::DynamicLibrary;
  using device::Unload;
  // A copy, because a library that is loaded already is not resolved again.
  const TempFolder folder;
  const auto file = folder.path() / "unresolved.so";
  std::filesystem::copy_file(TOUCHTRIAL_UNRESOLVED_HD, file);
  CHECK_THROWS_WITH(DynamicLibrary(file, Unload::when_closed, "do this"),
                    holds_text("touchtrial_no_such_function"));
  CHECK_NOTHROW(DynamicLibrary(file, Unload::when_closed, "do this", Binding::as_needed));
}

}  // namespace
}  // namespace touchtrial
