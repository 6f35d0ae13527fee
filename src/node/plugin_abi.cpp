#include "node/plugin_abi.h"

#include <dlfcn.h>
#include <link.h>

#include <memory>

namespace grinder {

std::optional<std::uint32_t> driveAbiOf(const std::string& library) {
  const std::unique_ptr<void, int (*)(void*)> handle(dlopen(library.c_str(), RTLD_LAZY | RTLD_NOLOAD), dlclose);
  if (!handle) return std::nullopt;
  const void* abi = dlsym(handle.get(), "flute_grinder_drive_abi");
  const link_map* loaded = nullptr;
  Dl_info owner;
  if (!abi || dlinfo(handle.get(), RTLD_DI_LINKMAP, &loaded) != 0 || dladdr(abi, &owner) == 0) return std::nullopt;
  // dlsym() also searches the libraries that the plugin is linked with.
  if (reinterpret_cast<ElfW(Addr)>(owner.dli_fbase) != loaded->l_addr) return std::nullopt;
  return *static_cast<const std::uint32_t*>(abi);
}

}  // namespace grinder
