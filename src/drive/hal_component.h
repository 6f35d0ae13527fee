#pragma once

#include <hal.h>

#include <cstddef>
#include <string>
#include <vector>

namespace grinder {

/// A user-space component of LinuxCNC's HAL. Each pin `<component>.<pin>` is linked to the signal `<pin>`, which the
/// HAL file creates. The HAL file is loaded first and stays loaded when this program starts and ends. Not real-time.
class HalComponent {
 public:
  /// Attaches to HAL. Removes a component of the same name left by a dead program; its signals stay.
  /// @param name name of the component, up to 20 characters.
  /// @throw ParameterError if HAL is not running or denies permission, or if a running program has a component of that
  ///        name.
  explicit HalComponent(const std::string& name);
  ~HalComponent();
  HalComponent(const HalComponent&) = delete;
  HalComponent& operator=(const HalComponent&) = delete;

  int id() const { return id_; }
  const std::string& name() const { return name_; }

  /// Zeroed memory accessible to HAL, for the pins' pointers.
  /// @throw ParameterError if HAL has no memory left.
  void* allocate(std::size_t size) const;

  /// Creates a pin and links it to its signal.
  /// @param name name of pin and signal.
  /// @param data where HAL stores the address of the value; from allocate().
  /// @param required whether the signal must exist; ready() reports missing signals.
  /// @return whether the signal exists.
  /// @throw ParameterError if the signal has another type or another writer.
  template <typename Value>
  bool addPin(const std::string& name, hal_pin_dir_t direction, Value*& data, bool required) {
    return addPin(name, typeOf(&data), direction, const_cast<void**>(reinterpret_cast<volatile void**>(&data)),
                  required);
  }

  /// Reports to HAL that all pins have been created.
  /// @throw ParameterError listing the missing signals.
  void ready() const;

 private:
  static constexpr hal_type_t typeOf(hal_bit_t**) { return HAL_BIT; }
  static constexpr hal_type_t typeOf(hal_float_t**) { return HAL_FLOAT; }
  static constexpr hal_type_t typeOf(hal_s32_t**) { return HAL_S32; }
  static constexpr hal_type_t typeOf(hal_u32_t**) { return HAL_U32; }

  HalComponent() = default;
  bool addPin(const std::string& name, hal_type_t type, hal_pin_dir_t direction, void** data, bool required);
  void removeDead(int reason);

  std::string name_;
  int id_ = -1;
  int helper_ = -1;  ///< a second component, if a dead one was removed
  std::vector<std::string> missing_;
};

/// Checks that a HAL shared memory exists and that this user may access it.
/// @param key key for shmget().
/// @param what name of the memory for the error message, e.g. "HAL".
/// @param remedy what to do if it does not exist.
/// @return its size in bytes.
/// @throw ParameterError unless it exists and is readable and writable.
std::size_t requireHalMemory(int key, const std::string& what, const std::string& remedy);

}  // namespace grinder
