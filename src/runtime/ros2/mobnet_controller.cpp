// A ros2_control controller around the library: it reads state interfaces, commands nothing, and exports what it finds
// as state interfaces that other controllers read (README.md). Written for the interface of ros2_control in Jazzy; it
// has never been compiled with ROS.
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "controller_interface/chainable_controller_interface.hpp"
#include "mobnet.h"
#include "pluginlib/class_list_macros.hpp"
#include "rclcpp/logging.hpp"

namespace mobnet_controller
{
using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;
using controller_interface::interface_configuration_type;
using controller_interface::return_type;

class MobnetController : public controller_interface::ChainableControllerInterface
{
public:
  CallbackReturn on_init() override
  {
    auto_declare<std::string>("model", "");
    auto_declare<std::vector<std::string>>("interfaces", {});
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_configure(const rclcpp_lifecycle::State &) override
  {
    const auto status = load(get_node()->get_parameter("model").as_string());
    if (status != MOBNET_OK) {
      return refused(mobnet_text(status));
    }
    sizes_ = mobnet_sizes_of(handle_);
    interfaces_ = get_node()->get_parameter("interfaces").as_string_array();
    if (interfaces_.size() != sizes_.columns) {
      return refused("`interfaces` must name one state interface for each column of the model");
    }
    if (std::abs(sizes_.rate_hz - get_update_rate()) > 1e-6 * sizes_.rate_hz) {
      return refused("the update rate is not that of the model");
    }
    numbers_.assign(sizes_.columns, 0.0);
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_activate(const rclcpp_lifecycle::State &) override
  {
    mobnet_reset(handle_);
    return CallbackReturn::SUCCESS;
  }

  InterfaceConfiguration command_interface_configuration() const override
  {
    return {interface_configuration_type::NONE, {}};
  }

  InterfaceConfiguration state_interface_configuration() const override
  {
    return {interface_configuration_type::INDIVIDUAL, interfaces_};
  }

protected:
  std::vector<hardware_interface::StateInterface> on_export_state_interfaces() override
  {
    std::vector<std::string> names;
    for (const char * kind : {"external_torque", "std"}) {
      for (size_t k = 0; k < sizes_.nv; k++) {
        names.push_back(std::string(mobnet_joint_name(handle_, k)) + "/" + kind);
      }
    }
    for (size_t k = 0; k < sizes_.detectors; k++) {
      names.push_back(std::string(mobnet_detector_name(handle_, k)) + "/alarm");
    }
    names.push_back("status");
    // The interfaces keep pointers to the values, which must not move after this.
    state_interfaces_values_.assign(names.size(), 0.0);
    std::vector<hardware_interface::StateInterface> exported;
    for (size_t k = 0; k < names.size(); k++) {
      exported.emplace_back(get_node()->get_name(), names[k], &state_interfaces_values_[k]);
    }
    return exported;
  }

  return_type update_reference_from_subscribers(const rclcpp::Time &, const rclcpp::Duration &) override
  {
    return return_type::OK;  // it has no references
  }

  return_type update_and_write_commands(const rclcpp::Time &, const rclcpp::Duration &) override
  {
    for (size_t k = 0; k < numbers_.size(); k++) {
      // A value that cannot be read now is none: the library refuses the sample.
      numbers_[k] = state_interfaces_[k].get_optional().value_or(std::nan(""));
    }
    const auto sample = sample_of(numbers_.data());
    mobnet_result result;
    const auto status = mobnet_step(handle_, &sample, &result);
    auto value = state_interfaces_values_.begin();
    for (size_t k = 0; k < sizes_.nv; k++) {
      *value++ = result.tau_ext[k];
    }
    for (size_t k = 0; k < sizes_.nv; k++) {
      *value++ = result.std[k];
    }
    for (size_t k = 0; k < sizes_.detectors; k++) {
      *value++ = result.alarms[k].ratio;
    }
    *value = status;
    return return_type::OK;
  }

private:
  mobnet_status load(const std::string & path)
  {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> model{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    size_t size = 0;
    const auto status = mobnet_size(model.data(), model.size(), &size);
    if (status != MOBNET_OK) {
      return status;
    }
    memory_.assign(size, 0);
    return mobnet_init(memory_.data(), size, model.data(), model.size(), &handle_);
  }

  CallbackReturn refused(const char * text)
  {
    RCLCPP_ERROR(get_node()->get_logger(), "%s", text);
    return CallbackReturn::ERROR;
  }

  mobnet_sample sample_of(const double * numbers) const
  {
    mobnet_sample sample;
    sample.q = numbers;
    sample.v = sample.q + sizes_.nq;
    sample.tau_motor = sample.v + sizes_.nv;
    sample.tau_des = sample.tau_motor + sizes_.nu;
    sample.acc = sample.tau_des + sizes_.nu;
    sample.swing = sample.acc + (sizes_.floating ? 3 : 0);
    sample.landing = sample.swing + sizes_.feet;
    return sample;
  }

  mobnet * handle_ = nullptr;
  mobnet_sizes sizes_{};
  std::vector<unsigned char> memory_;
  std::vector<std::string> interfaces_;
  std::vector<double> numbers_;
};
}  // namespace mobnet_controller

PLUGINLIB_EXPORT_CLASS(mobnet_controller::MobnetController, controller_interface::ChainableControllerInterface)
