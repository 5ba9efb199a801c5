#include "core/errors.hpp"
#include "record/merging/bundle_table.hpp"

#include <filesystem>
#include <system_error>

#include <dlfcn.h>

namespace touchtrial::merging {

std::unique_ptr<BundleTable> open_bundle_table(const std::string& address) {
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  void* module = nullptr;
  // The module's folders in the build and after installation.
  for (const char* const folder : {".", "../lib/touchtrial"}) {
    // The module is never unloaded, because its exceptions may outlive the table.
    const auto path = program / folder / "touchtrial_postgres.so";
    if (module == nullptr) module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  }
  using Open = BundleTable*(const std::string&);
  void* const open = module == nullptr ? nullptr : dlsym(module, "touchtrial_open_bundle_table");
  if (open == nullptr) {
    const char* const reason = dlerror();
    throw StoreError(one_line(std::string("the part for PostgreSQL cannot be loaded (") +
                              (reason == nullptr ? "no reason given" : reason) +
                              "); install the package touchtrial-postgres, or libpq5"));
  }
  return std::unique_ptr<BundleTable>(reinterpret_cast<Open*>(open)(address));
}

}  // namespace touchtrial::merging
