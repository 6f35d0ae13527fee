#include "node/drive_plugin.h"

#include "flute_grinder/base/fault_text.h"
#include "flute_grinder/drive/export_drive.h"

#include <dlfcn.h>
#include <link.h>

#include <boost/algorithm/string/join.hpp>

#include <cstdint>
#include <memory>
#include <optional>

namespace grinder {

namespace {

const std::string kSimulatedDrive = "flute_grinder/SimulatedDrive";

/// The version of the drive interface that a plugin was built against (flute_grinder/drive/export_drive.h). Runs no
/// code of the plugin.
/// @param library path of the plugin's library, which has been loaded.
/// @return nothing if the library itself states no version, even if a library that it is linked with does.
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

/// Refuses a loaded plugin that was built against another version of the drive interface.
void checkAbi(const std::string& parameter, const std::string& library) {
  const auto abi = driveAbiOf(library);
  if (abi == kDriveAbi) return;
  throw ParameterError("parameter " + parameter +
                       (abi ? " was built against version " + std::to_string(*abi) + " of the drive interface"
                            : " states no version of the drive interface") +
                       "; allowed: version " + std::to_string(kDriveAbi) + ". Build it again: " + library);
}

}  // namespace

DrivePlugin::DrivePlugin(const EndSignals& signals) : signals_(signals), loader_("flute_grinder", "grinder::Drive") {}

DrivePlugin::~DrivePlugin() {
  if (!drive_) return;
  const EndInTime guard(named("destructor"));
  drive_.reset();
}

std::string DrivePlugin::declared() { return boost::algorithm::join(loader_.getDeclaredClasses(), "; "); }

void DrivePlugin::load(const std::string& type, const ParameterReader& parameters) {
  type_ = type;
  if (type != kSimulatedDrive && parameters.has("hardware/pace")) {
    throw ParameterError("parameter " + parameters.name("hardware/pace") +
                         "; allowed: for flute_grinder/SimulatedDrive alone");
  }
  const std::string parameter = parameters.name("hardware/type") + " = " + type;
  if (!loader_.isClassAvailable(type)) {
    throw ParameterError("parameter " + parameter + "; allowed: " + declared());
  }
  try {
    call("library", [&] { loader_.loadLibraryForClass(type); });
    checkAbi(parameter, loader_.getClassLibraryPath(type));
    call("constructor", [&] { drive_ = loader_.createUniqueInstance(type); });
  } catch (const pluginlib::PluginlibException& error) {
    throw ParameterError("parameter " + parameter + " cannot be loaded: " + error.what() +
                         " What it is: " + loader_.getClassDescription(type));
  }
}

void DrivePlugin::call(const char* function, const std::function<void()>& call) const {
  const EndAtOnce guard(signals_, named(function));
  try {
    call();
  } catch (const pluginlib::PluginlibException&) {
    throw;
  } catch (const std::exception& error) {
    throw ParameterError("the drive " + type_ + ": " + std::string(textOrNone(error)));
  } catch (...) {
    throw ParameterError("the drive " + type_ + ": its " + function + " has thrown what is no std::exception");
  }
}

}  // namespace grinder
