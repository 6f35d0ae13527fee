#include "drive/hal_component.h"

#include "flute_grinder/drive/parameters.h"

#include <signal.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace grinder {

namespace {

/// Key of HAL's own shared memory; hal_init() would create the memory if HAL is not running.
constexpr int kHalKey = 0x48414C32;
constexpr int kMaxId = 1 << 16;
constexpr const char* kProcessPin = "process";

const char* typeName(hal_type_t type) {
  switch (type) {
    case HAL_BIT: return "bit";
    case HAL_FLOAT: return "float";
    case HAL_S32: return "s32";
    case HAL_U32: return "u32";
    default: return "other";
  }
}

}  // namespace

std::size_t requireHalMemory(int key, const std::string& what, const std::string& remedy) {
  const int id = shmget(key, 0, 0);
  if (id < 0) throw ParameterError(what + " is not there (" + std::strerror(errno) + "); " + remedy);
  shmid_ds status{};
  const void* memory = shmat(id, nullptr, 0);
  if (reinterpret_cast<std::intptr_t>(memory) == -1 || shmctl(id, IPC_STAT, &status) != 0) {
    throw ParameterError("no permission to use " + what + " as user " + std::to_string(geteuid()) +
                         "; allowed: the user that has started HAL");
  }
  shmdt(memory);
  return status.shm_segsz;
}

HalComponent::HalComponent(const std::string& name) : HalComponent() {
  name_ = name;
  requireHalMemory(kHalKey, "LinuxCNC's HAL", "start it first: halcmd -f FILE.hal");
  id_ = hal_init(name_.c_str());
  if (id_ < 0) {
    removeDead(id_);
    id_ = hal_init(name_.c_str());
  }
  if (id_ < 0) throw ParameterError("HAL takes no component '" + name_ + "': " + std::strerror(-id_));
  auto*& process = *static_cast<hal_s32_t**>(allocate(sizeof(hal_s32_t*)));
  addPin(kProcessPin, HAL_OUT, process, false);
  *process = getpid();
}

HalComponent::~HalComponent() {
  if (id_ >= 0) hal_exit(id_);
  if (helper_ >= 0) hal_exit(helper_);
}

void HalComponent::removeDead(int reason) {
  // HAL's library detaches from HAL when its count of components reaches 0, and removing another program's component
  // decrements the count: a second component of our own compensates for this.
  helper_ = hal_init((name_ + '-' + std::to_string(getpid())).c_str());
  if (helper_ < 0) throw ParameterError("HAL takes no component '" + name_ + "': " + std::strerror(-reason));
  int other = 1;
  for (const char* name = ""; other < kMaxId; ++other) {
    name = hal_comp_name(other);
    if (name && name == name_) break;
  }
  const std::string taken = "HAL has a component '" + name_ + "' already";
  hal_type_t type = HAL_TYPE_UNSPECIFIED;
  hal_data_u* process = nullptr;
  const std::string pin = name_ + '.' + kProcessPin;
  if (other == kMaxId || hal_get_pin_value_by_name(pin.c_str(), &type, &process, nullptr) != 0) {
    throw ParameterError(taken + ", and it is not a grinder's; allowed: another name");
  }
  if (kill(process->s, 0) == 0 || errno != ESRCH) {
    throw ParameterError(taken + ", of the running process " + std::to_string(process->s) +
                         "; allowed: to end that first, or another name");
  }
  hal_exit(other);
}

void* HalComponent::allocate(std::size_t size) const {
  void* memory = hal_malloc(static_cast<long>(size));
  if (!memory) throw ParameterError("HAL has no memory left for component '" + name_ + "'");
  std::memset(memory, 0, size);
  return memory;
}

bool HalComponent::addPin(const std::string& name, hal_type_t type, hal_pin_dir_t direction, void** data,
                          bool required) {
  const std::string full = name_ + '.' + name;
  const int made = hal_pin_new(full.c_str(), type, direction, data, id_);
  if (made < 0) throw ParameterError("HAL makes no pin '" + full + "': " + std::strerror(-made));
  hal_type_t signal_type = HAL_TYPE_UNSPECIFIED;
  hal_data_u* value = nullptr;
  bool written = false;
  if (hal_get_signal_value_by_name(name.c_str(), &signal_type, &value, &written) != 0) {
    if (required) missing_.push_back(name);
    return false;
  }
  if (signal_type != type) {
    throw ParameterError("HAL's signal '" + name + "' is of type " + typeName(signal_type) +
                         "; allowed: " + typeName(type));
  }
  if (written && direction == HAL_OUT) {
    throw ParameterError("HAL's signal '" + name + "' has a writer already; allowed: none beside " + full);
  }
  // A signal that was only set by the HAL file takes the value of the first pin linked to it.
  if (direction == HAL_IN) std::memcpy(*data, value, sizeof(*value));
  const int linked = hal_link(full.c_str(), name.c_str());
  if (linked < 0) throw ParameterError("HAL does not link pin '" + full + "': " + std::strerror(-linked));
  return true;
}

void HalComponent::ready() const {
  std::string names;
  for (const std::string& name : missing_) names += (names.empty() ? "" : ", ") + name;
  if (!missing_.empty()) {
    throw ParameterError("HAL lacks the signals " + names + "; allowed: a HAL file that makes them all");
  }
  hal_ready(id_);
}

}  // namespace grinder
