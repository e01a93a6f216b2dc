#pragma once
#include <functional>
#include <string>
#include <vector>

namespace railstep {

/// One way to step a scene, with what it errs by; its time is measured in turns with the others'.
struct Contestant {
  std::string peer, scene;
  int elements;  // of a rail or a beam
  double step;   // s; 0: as the tolerance asks for
  double error;  // moving_load: largest over peak after start-up; double_pendulum: of C, m
  double error_from_start;        // the same from the first step on; NaN: not told
  double reference_error;         // of what `error` is against, in its unit
  int unknowns;                   // in all
  double flops;                   // of 1 ms; NaN: not counted
  std::function<double()> frame;  // 1 ms; what it returns is only kept from being left out
  int passage = 0;                // frames timed together at least; 0: enough for 2 ms
  std::vector<double> us = {};    // of 1 ms, one of every round
};

/// Each round times a block of every contestant, one after the other, so that what slows the
/// machine for a while slows all of them.
void hold_contest(std::vector<Contestant>& all, int rounds);

/// CSV: peer,scene,elements,step_s,us_per_ms,error,reference_error,us_low,us_high,unknowns,
/// flops_per_ms,error_from_start. Times are the median and the quartiles of the rounds.
void print_head();
void print_rows(const std::vector<Contestant>& all);

/// The scenes' contestants. @param elements  of a rail
std::vector<Contestant> moving_load_contest(int elements);
std::vector<Contestant> work_precision_contest(int elements);
std::vector<Contestant> double_pendulum_contest();

}  // namespace railstep
