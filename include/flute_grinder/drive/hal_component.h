#pragma once

#include <hal.h>

#include <cstddef>
#include <string>
#include <vector>

namespace flute_grinder {

/// A user-space component of LinuxCNC's HAL. A pin `<component>.<pin>` is linked to the signal `<pin>`, which the HAL
/// file creates: the HAL file is loaded first, and stays loaded when the program starts and ends. Not real-time.
class HalComponent {
 public:
  /// Attaches to HAL. A component of the same name left by a dead program is removed; its signals stay.
  /// @param name of the component, up to 20 characters.
  /// @throw ParameterError if HAL does not run, denies permission, or has a component of that name whose program runs.
  explicit HalComponent(const std::string& name);
  ~HalComponent();
  HalComponent(const HalComponent&) = delete;
  HalComponent& operator=(const HalComponent&) = delete;

  int id() const { return id_; }
  const std::string& name() const { return name_; }

  /// Zeroed memory that HAL can access, for the pins' pointers.
  /// @throw ParameterError if HAL has none left.
  void* allocate(std::size_t size) const;

  /// Creates a pin and links it to its signal.
  /// @param name of pin and signal.
  /// @param data where HAL puts the address of the value; from allocate().
  /// @param required whether the signal must exist; ready() reports the missing ones.
  /// @throw ParameterError if the signal is of another type or has another writer.
  template <typename Value>
  void addPin(const std::string& name, hal_pin_dir_t direction, Value*& data, bool required) {
    addPin(name, typeOf(&data), direction, const_cast<void**>(reinterpret_cast<volatile void**>(&data)), required);
  }

  /// Reports to HAL that all pins exist.
  /// @throw ParameterError that lists the missing signals.
  void ready() const;

 private:
  static constexpr hal_type_t typeOf(hal_bit_t**) { return HAL_BIT; }
  static constexpr hal_type_t typeOf(hal_float_t**) { return HAL_FLOAT; }
  static constexpr hal_type_t typeOf(hal_s32_t**) { return HAL_S32; }
  static constexpr hal_type_t typeOf(hal_u32_t**) { return HAL_U32; }

  HalComponent() = default;
  void addPin(const std::string& name, hal_type_t type, hal_pin_dir_t direction, void** data, bool required);
  void removeDead(int reason);

  std::string name_;
  int id_ = -1;
  int helper_ = -1;  ///< a second component, if a dead one was removed
  std::vector<std::string> missing_;
};

/// Checks that a shared memory of HAL exists and that this user may access it.
/// @param key as of shmget().
/// @param what it is, for the message, e.g. "HAL".
/// @param remedy what to do if it does not exist.
/// @return its size in bytes.
/// @throw ParameterError unless it exists and may be read and written.
std::size_t requireHalMemory(int key, const std::string& what, const std::string& remedy);

}  // namespace flute_grinder
