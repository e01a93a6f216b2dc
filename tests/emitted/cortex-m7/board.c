/* Lets main.c run on a Cortex-M7 without a system: vectors, the start, and a console and an end by
 * semihosting (Arm IHI 0100), which a debugger or an emulator answers. */
#include <stdint.h>

#include "../say.h"

void start(void);
extern uint32_t stack_top[], data_from[], data_start[], data_end[], bss_start[], bss_end[];
int main(void);

static void semihost(uint32_t call, const void* with) {
  register uint32_t r0 __asm__("r0") = call;
  register const void* r1 __asm__("r1") = with;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void say(const char* text) { semihost(0x04, text); } /* SYS_WRITE0 */

static void leave(uint32_t code) { /* SYS_EXIT_EXTENDED */
  const uint32_t why[2] = {0x20026, code}; /* ADP_Stopped_ApplicationExit */
  semihost(0x20, why);
  for (;;) {
  }
}

static void lost(void) {
  say("error: a fault of the processor\n");
  leave(1);
}

void start(void) {
  const uint32_t* from = data_from;
  uint32_t* at;
  *(volatile uint32_t*)0xe000ed88u |= 0xfu << 20; /* CPACR: the floating-point unit is on */
  __asm__ volatile("dsb\n isb" : : : "memory");
  for (at = data_start; at < data_end; ++at) *at = *from++;
  for (at = bss_start; at < bss_end; ++at) *at = 0;
  leave((uint32_t)main());
}

typedef void (*handler)(void);
__attribute__((section(".vectors"), used)) static const struct {
  const uint32_t* stack;
  handler reset, faults[14];
} vectors = {stack_top,
             start,
             {lost, lost, lost, lost, lost, lost, lost, lost, lost, lost, lost, lost, lost, lost}};
