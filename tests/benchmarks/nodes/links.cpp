// SPDX-License-Identifier: BSD-3-Clause
// Compares, in simulated time and along one direction, three kinds of data that the link between device and
// render can carry: states of proxy and part, from which each end evaluates the coupling (ours); wave
// variables [Niemeyer and Slotine 1991]; and force and velocity with passivity observers and controllers at
// both ends [Ryu, Artigas, Preusche 2010].
//
// A hand (spring and damper) moves the device along a path: freely, into a wall, where it stays, and back.
// Device, part, wall, delays, losses and random numbers are the same for all kinds.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "rows.h"
#include "vps_device/gains.h"

namespace vps::bench {

namespace {

constexpr double kRate_hz = 1600, kTick_s = 1 / kRate_hz;
constexpr int kFine = 8;  // steps of the device's motion in a tick

// assumed: an arm with a light handle, and a hand that leads it with a few newtons
constexpr double kDeviceMass_kg = 0.3, kDeviceDamping_Ns_per_m = 2;
constexpr double kHand_N_per_m = 300, kHand_Ns_per_m = 5;
constexpr double kPart_kg = 0.2, kWall_N_per_m = 1e5, kWall_Ns_per_m = 100, kWall_m = 0.04;

struct Net {
  double delay_s = 0, jitter_s = 0, loss = 0;
};

/// One direction of a network: packets arrive late, in another order, or not at all.
template <typename Packet>
class Wire {
 public:
  Wire(const Net& net, unsigned seed) : net_(net), random_(seed) {}
  void send(double now_s, const Packet& packet) {
    std::uniform_real_distribution<double> share(0, 1);
    const bool is_lost = share(random_) < net_.loss;
    const double late_s = net_.delay_s + net_.jitter_s * share(random_);
    if (!is_lost) under_way_.push_back({now_s + late_s, packet});
  }
  /// All packets that have arrived, in the order of arrival.
  std::vector<Packet> receive(double now_s) {
    std::vector<std::pair<double, Packet>> all;
    std::erase_if(under_way_, [&](const auto& one) {
      if (one.first > now_s) return false;
      all.push_back(one);
      return true;
    });
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Packet> packets;
    for (const auto& one : all) packets.push_back(one.second);
    return packets;
  }

 private:
  Net net_;
  std::mt19937 random_;
  std::vector<std::pair<double, Packet>> under_way_;
};

/// The part and its wall, with an implicit step.
struct Part {
  double x_m = 0, v_m_per_s = 0;
  /// One step, in which a spring and damper pull the part to a moving position, and a constant force acts.
  void step(double k, double b, double to_m, double to_m_per_s, double held_N = 0) {
    const bool touches = x_m + kTick_s * v_m_per_s > kWall_m;
    const double k_wall = touches ? kWall_N_per_m : 0, b_wall = touches ? kWall_Ns_per_m : 0;
    const double force_N = held_N + k * (to_m - x_m) + b * to_m_per_s + k_wall * (kWall_m - x_m);
    const double damping = b + b_wall + kTick_s * (k + k_wall);
    v_m_per_s = (kPart_kg * v_m_per_s + kTick_s * force_N) / (kPart_kg + kTick_s * damping);
    x_m += kTick_s * v_m_per_s;
  }
  void push(double force_N) { step(0, 0, 0, 0, force_N); }
};

/// Runs both ends for a tick. Returns the force on the hand [N].
class LinkModel {
 public:
  virtual ~LinkModel() = default;
  virtual double tick(double now_s, double x_m, double v_m_per_s) = 0;
  Part part;
};

CouplingGains gainsAt(double round_trip_s) {
  device::DeviceLimits limits;
  limits.damping_Ns_per_m = kDeviceDamping_Ns_per_m;
  device::CouplingTiming timing;
  timing.haptic_rate_hz = timing.physics_rate_hz = kRate_hz;
  timing.delay_s = round_trip_s;
  return device::deriveGains(limits, timing);
}

struct State {
  double sent_s = 0, x_m = 0, v_m_per_s = 0;
};
/// Takes the newest state that has arrived.
void takeNewest(Wire<State>& wire, double now_s, State& state) {
  for (const State& one : wire.receive(now_s))
    if (one.sent_s >= state.sent_s) state = one;
}

class StateLink final : public LinkModel {
 public:
  explicit StateLink(const Net& net)
      : there_(net, 1), back_(net, 2), gains_(gainsAt(2 * (net.delay_s + net.jitter_s))) {}
  double tick(double now_s, double x_m, double v_m_per_s) override {
    there_.send(now_s, {now_s, x_m, v_m_per_s});
    takeNewest(there_, now_s, proxy_);
    part.step(gains_.k_N_per_m, gains_.b_Ns_per_m, proxy_.x_m, proxy_.v_m_per_s);
    back_.send(now_s, {now_s, part.x_m, part.v_m_per_s});
    takeNewest(back_, now_s, seen_);
    return gains_.k_N_per_m * (seen_.x_m - x_m) + gains_.b_Ns_per_m * (seen_.v_m_per_s - v_m_per_s);
  }

 private:
  Wire<State> there_, back_;
  State proxy_, seen_;
  CouplingGains gains_;
};

/// Sends the sum and the energy of all waves so far, so that later packets make up for lost packets, as far
/// as the energy that was sent allows [Niemeyer and Slotine 1998]. Each packet is used only after the longest
/// possible delay, so that jitter does not distort the waves.
class WaveWay {
 public:
  WaveWay(const Net& net, unsigned seed) : wire_(net, seed), late_s_(net.delay_s + net.jitter_s) {}
  void send(double now_s, double wave) {
    sent_.sent_s = now_s;
    sent_.sum += kTick_s * wave;
    sent_.energy_J += 0.5 * kTick_s * wave * wave;
    wire_.send(now_s, sent_);
  }
  double receive(double now_s) {
    for (const Sums& one : wire_.receive(now_s)) waiting_.push_back(one);
    std::erase_if(waiting_, [&](const Sums& one) {
      const bool is_due = one.sent_s + late_s_ <= now_s;
      if (is_due && one.sent_s >= due_.sent_s) due_ = one;
      return is_due;
    });
    const double most = std::sqrt(2 * std::max(0.0, due_.energy_J - used_.energy_J) / kTick_s);
    const double wave = std::clamp((due_.sum - used_.sum) / kTick_s, -most, most);
    used_.sum += kTick_s * wave;
    used_.energy_J += 0.5 * kTick_s * wave * wave;
    return wave;
  }

 private:
  struct Sums {
    double sent_s = 0, sum = 0, energy_J = 0;
  };
  Wire<Sums> wire_;
  double late_s_;
  std::vector<Sums> waiting_;
  Sums sent_, due_, used_;
};

/// The stiffest coupling that is possible on one machine acts between the end of the link and the part; the
/// link itself is passive.
class WaveLink final : public LinkModel {
 public:
  WaveLink(const Net& net, double impedance_Ns_per_m)
      : there_(net, 1), back_(net, 2), b_(impedance_Ns_per_m), gains_(gainsAt(0)) {}
  double tick(double now_s, double, double v_m_per_s) override {
    const double root = std::sqrt(2 * b_);
    const double in_v = back_.receive(now_s);
    const double force_N = b_ * v_m_per_s - root * in_v;  // force of the link against the device
    there_.send(now_s, root * v_m_per_s - in_v);
    const double in_u = there_.receive(now_s);
    const double k = gains_.k_N_per_m, b = gains_.b_Ns_per_m, free_m_per_s = root * in_u / b_;
    // The end's velocity and the coupling's force depend on each other.
    const double f_N =
        (k * (end_m_ + kTick_s * free_m_per_s - part.x_m) + b * (free_m_per_s - part.v_m_per_s)) /
        (1 + (b + k * kTick_s) / b_);
    end_m_ += kTick_s * (root * in_u - f_N) / b_;
    part.push(f_N);
    back_.send(now_s, in_u - std::sqrt(2 / b_) * f_N);
    return -force_N;
  }

 private:
  WaveWay there_, back_;
  double b_, end_m_ = 0;
  CouplingGains gains_;
};

/// Sends velocity to the part and force back, each with the energy that went in at its end. Each end
/// dissipates the energy that exceeds the energy which went in at the other end.
class PassivityLink final : public LinkModel {
 public:
  explicit PassivityLink(const Net& net) : there_(net, 1), back_(net, 2), gains_(gainsAt(0)) {}
  double tick(double now_s, double, double v_m_per_s) override {
    there_.send(now_s, {now_s, v_m_per_s, device_in_J_});
    Port arrived = last_there_;
    for (const Port& one : there_.receive(now_s))
      if (one.sent_s >= arrived.sent_s) arrived = one;
    last_there_ = arrived;
    // At the part: the velocity that arrived, reduced if it would give more energy than went in.
    double end_m_per_s = arrived.value;
    const double k = gains_.k_N_per_m, b = gains_.b_Ns_per_m;
    const double f_N = k * (end_m_ - part.x_m) + b * (end_m_per_s - part.v_m_per_s);
    const double power_W = f_N * end_m_per_s;
    if (power_W > 0)
      part_out_J_ += kTick_s * power_W;
    else
      part_in_J_ -= kTick_s * power_W;
    const double excess_J = part_out_J_ - arrived.energy_J;
    if (excess_J > 0 && std::abs(f_N) > 1e-6) {
      end_m_per_s -= excess_J / (kTick_s * f_N);
      part_out_J_ -= excess_J;
    }
    end_m_ += kTick_s * end_m_per_s;
    part.push(f_N);
    back_.send(now_s, {now_s, f_N, part_in_J_});
    for (const Port& one : back_.receive(now_s))
      if (one.sent_s >= last_back_.sent_s) last_back_ = one;
    // At the device: the force that arrived, and damping of energy in excess of the energy that went in at
    // the part.
    double force_N = last_back_.value;  // force against the device's motion
    const double out_W = -force_N * v_m_per_s;
    if (out_W > 0)
      device_out_J_ += kTick_s * out_W;
    else
      device_in_J_ -= kTick_s * out_W;
    const double beyond_J = device_out_J_ - last_back_.energy_J;
    constexpr double kStill_m_per_s = 1e-4;  // below this speed a damper has no effect
    if (beyond_J > 0 && std::abs(v_m_per_s) > kStill_m_per_s) {
      // A damper that reverses the device's motion within a tick would itself generate energy.
      const double damping =
          std::min(beyond_J / (kTick_s * v_m_per_s * v_m_per_s), kDeviceMass_kg / (2 * kTick_s));
      force_N += damping * v_m_per_s;
      device_out_J_ -= kTick_s * damping * v_m_per_s * v_m_per_s;
    }
    return -force_N;
  }

 private:
  struct Port {
    double sent_s = 0, value = 0, energy_J = 0;
  };
  Wire<Port> there_, back_;
  Port last_there_, last_back_;
  double device_in_J_ = 0, device_out_J_ = 0, part_in_J_ = 0, part_out_J_ = 0, end_m_ = 0;
  CouplingGains gains_;
};

struct Outcome {
  double injected_J = 0;  ///< greatest energy that the handle gave in excess of the energy it had received
  double stiffness = 0;   ///< stiffness that the hand feels in the wall [N/m]
  double drag_N = 0;      ///< resistance in free motion at 0.1 m/s
  double greatest_step_N = 0;  ///< greatest change of force from tick to tick, also after an outage of 0.1 s
  double shaking_m_per_s = 0;  ///< rms of the handle's velocity while the hand holds still in the wall
  double drift_m = 0;          ///< offset between handle and part at the end
};

/// The position to which the hand leads the handle: at 0.1 m/s to 20 mm beyond the wall, two seconds there,
/// and back.
double wish_m(double now_s) {
  constexpr double kSpeed = 0.1, kDeepest_m = kWall_m + 0.02, kStay_s = 2;
  const double there_s = kDeepest_m / kSpeed;
  if (now_s < there_s) return kSpeed * now_s;
  return std::max(0.0, kDeepest_m - kSpeed * std::max(0.0, now_s - there_s - kStay_s));
}

Outcome measure(LinkModel& link) {
  Outcome outcome;
  double x_m = 0, v = 0, energy_J = 0, last_N = 0, drag_N = 0, held_N = 0, held_m = 0, square = 0;
  int dragged = 0, held = 0;
  constexpr double kEnd_s = 4.5;
  for (int tick = 0; tick * kTick_s < kEnd_s; ++tick) {
    const double now_s = tick * kTick_s;
    const double force_N = link.tick(now_s, x_m, v);  // held for a tick
    for (int i = 0; i < kFine; ++i) {
      const double dt_s = kTick_s / kFine, at_s = now_s + i * dt_s;
      const double wish_v = (wish_m(at_s + dt_s) - wish_m(at_s)) / dt_s;
      const double pull_N = kHand_N_per_m * (wish_m(at_s) - x_m) + kHand_Ns_per_m * (wish_v - v);
      v = (kDeviceMass_kg * v + dt_s * (force_N + pull_N)) /
          (kDeviceMass_kg + dt_s * kDeviceDamping_Ns_per_m);
      x_m += dt_s * v;
      energy_J -= dt_s * force_N * v;  // energy that the link received from the handle
    }
    outcome.injected_J = std::max(outcome.injected_J, -energy_J);
    outcome.greatest_step_N = std::max(outcome.greatest_step_N, std::abs(force_N - last_N));
    last_N = force_N;
    if (now_s > 0.2 && now_s < 0.35) drag_N -= force_N, ++dragged;
    if (now_s > 1.8 && now_s < 2.5) held_N -= force_N, held_m += x_m - kWall_m, square += v * v, ++held;
  }
  outcome.drag_N = drag_N / dragged;
  outcome.stiffness = held_m > 0 ? held_N / held_m : 0;
  outcome.shaking_m_per_s = std::sqrt(square / held);
  outcome.drift_m = link.part.x_m - x_m;
  return outcome;
}

}  // namespace

bool linkRows() {
  struct Named {
    const char* name;
    std::function<std::unique_ptr<LinkModel>(const Net&)> make;
  };
  const Named links[] = {
      {"states (ours)", [](const Net& net) { return std::make_unique<StateLink>(net); }},
      {"waves, 2 N s/m", [](const Net& net) { return std::make_unique<WaveLink>(net, 2); }},
      {"waves, 10 N s/m", [](const Net& net) { return std::make_unique<WaveLink>(net, 10); }},
      {"passivity controllers", [](const Net& net) { return std::make_unique<PassivityLink>(net); }}};
  const Net nets[] = {{0.001, 0, 0}, {0.001, 0.005, 0.05}, {0.005, 0.005, 0.05}, {0.02, 0.005, 0.05}};
  constexpr double kInjected_J = 1e-3;
  bool is_good = true;
  for (const Net& net : nets)
    for (const Named& link : links) {
      const Outcome o = measure(*link.make(net));
      char what[120], words[240];
      std::snprintf(what, sizeof what, "%s, delay %.0f ms, jitter %.0f ms, %.0f %% lost", link.name,
                    1e3 * net.delay_s, 1e3 * net.jitter_s, 100 * net.loss);
      std::snprintf(words, sizeof words,
                    "injected %.3f mJ, wall of %.0f N/m, drag %.2f N, greatest step %.2f N, shaking %.2f "
                    "mm/s, part off "
                    "the handle by %.2f mm",
                    1e3 * o.injected_J, o.stiffness, o.drag_N, o.greatest_step_N, 1e3 * o.shaking_m_per_s,
                    1e3 * o.drift_m);
      const bool is_reached = o.injected_J <= kInjected_J;
      printRow(what, "injected at most 1 mJ", words, is_reached);
      if (&link == &links[0]) is_good = is_good && is_reached;
    }
  return is_good;
}

}  // namespace vps::bench
