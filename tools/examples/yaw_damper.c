/* Active yaw dampers: a controller that railstep knows nothing of turns the bogies of a vehicle by
 * moments against their yaw in the car. It is closed through the C interface, or in another process
 * over UDP; both give the same bits.
 *
 * Usage: yaw_damper MODEL SECONDS                         a model of `railstep condense`
 *        yaw_damper HOST:PORT NAMES FRAME_S SECONDS       `railstep hil --udp HOST:PORT --names
 * NAMES` The scene has a vehicle `car` with bodies `car`, `bogie_1` and `bogie_2`, and two
 * actuators with the inputs `yaw_1` and `yaw_2`: yaw_damper.toml beside this file. Prints a line a
 * frame: time, both moments, yaw of both bogies in the car. */

#define _POSIX_C_SOURCE 200112L /* NOLINT(bugprone-reserved-identifier): POSIX wants it */
#include "hil_packets.h"
#include "loaded_model.h"

enum { kBogies = 2 };

/* Places of what the controller reads and gives. */
typedef struct {
  int car, bogie[kBogies], given[kBogies], moment[kBogies]; /* given: moments that acted */
} Places;

typedef struct {
  double yaw[kBogies]; /* of the frame before, rad */
  int begun;
} Controller;

/* A damper of 1 MN m s/rad on the difference over a frame, of 15 kN m at most. */
static void control(Controller* own, const Places* at, double frame_s, const double* outputs,
                    double* inputs) {
  const double damping = 1e6, most = 15e3;
  for (int i = 0; i < kBogies; ++i) {
    const double yaw = outputs[at->bogie[i]] - outputs[at->car];
    const double rate = own->begun ? (yaw - own->yaw[i]) / frame_s : 0.0;
    const double moment = -damping * rate;
    inputs[at->moment[i]] = moment > most ? most : moment < -most ? -most : moment;
    own->yaw[i] = yaw;
  }
  own->begun = 1;
}

static void print_frame(double time_s, const Places* at, const Controller* own,
                        const double* inputs) {
  printf("%.9g,%.17g,%.17g,%.17g,%.17g\n", time_s, inputs[at->moment[0]], inputs[at->moment[1]],
         own->yaw[0], own->yaw[1]);
}

static const char* const kCar = "car.car.yaw_rad";
static const char* const kBogie[kBogies] = {"car.bogie_1.yaw_rad", "car.bogie_2.yaw_rad"};
static const char* const kGiven[kBogies] = {"car.yaw_1.force_n", "car.yaw_2.force_n"};
static const char* const kMoment[kBogies] = {"yaw_1.moment_n_m", "yaw_2.moment_n_m"};

/* Through the C interface ------------------------------------------------------------------------
 */

static int is_known(const Places* at) {
  int known = at->car >= 0;
  for (int i = 0; i < kBogies; ++i)
    known = known && at->bogie[i] >= 0 && at->given[i] >= 0 && at->moment[i] >= 0;
  return known;
}

static int step_model(const railstep_model* model, railstep_run* run, double seconds) {
  Places at = {railstep_find_output(model, kCar), {0}, {0}, {0}};
  for (int i = 0; i < kBogies; ++i) {
    at.bogie[i] = railstep_find_output(model, kBogie[i]);
    at.given[i] = railstep_find_output(model, kGiven[i]);
    at.moment[i] = railstep_find_input(model, kMoment[i]);
  }
  if (!is_known(&at) || railstep_inputs(model) > kMostInputs)
    return fail("model", "a name of the controller is not in it; expected yaw_damper.toml");
  const double frame_s = railstep_frame_s(model);
  double* const out = malloc(sizeof(double) * (size_t)railstep_outputs(model));
  if (!out) return fail("memory", "there is none left");
  Controller own = {{0.0, 0.0}, 0};
  double in[kMostInputs] = {0};
  railstep_step(run, in); /* as over UDP, the first frame has no moments yet */
  railstep_read(run, out);
  for (long n = 1; (double)n * frame_s < seconds + .5 * frame_s; ++n) {
    control(&own, &at, frame_s, out, in);
    print_frame((double)n * frame_s, &at, &own, in);
    railstep_step(run, in);
    railstep_read(run, out);
  }
  free(out);
  return 0;
}

static int with_model(const char* file, double seconds) {
  Loaded loaded;
  const char* const why = load_model(file, &loaded);
  const int code = why ? fail(file, why) : step_model(loaded.model, loaded.run, seconds);
  free_model(&loaded);
  return code;
}

/* Over UDP ---------------------------------------------------------------------------------------
 */

/* Place of a name in one of the lists of a file of names; -1 without it. */
static int place_of(const char* file, const char* list, const char* name) {
  FILE* const in = fopen(file, "r");
  char line[512], word[16];
  unsigned count = 0, sum, place = 0;
  int ours = 0, found = -1;
  while (in && fgets(line, sizeof line, in)) {
    line[strcspn(line, "\r\n")] = 0;
    if (sscanf(line, "%15s %u %x", word, &count, &sum) == 3) {
      ours = strcmp(word, list) == 0;
      place = 0;
    } else if (ours && place < count && strcmp(line, name) == 0) {
      found = (int)place;
    } else {
      ++place;
    }
  }
  if (in) fclose(in);
  return found;
}

static int over_udp(int file, const Layout* layout, const Places* at, double frame_s, long frames) {
  static Outputs out;
  Controller own = {{0.0, 0.0}, 0};
  double in[kMostInputs] = {0};
  uint64_t sequence = 0;
  int64_t next = -1; /* frame that the inputs are for: at first any */
  long made = 0, missed = 0, silent = 0;
  send_inputs(file, layout, ++sequence, next, in);
  while (silent < 100 && made < frames) {
    const int heard = receive_outputs(file, layout, &out);
    silent = heard ? 0 : silent + 1;
    if (heard && (out.flags & 1u)) break; /* the run has ended */
    if (heard && out.frame >= next) {
      for (int i = 0; i < kBogies && next >= 0;
           ++i) /* frames that were made without their moments */
        missed += out.frame > next || out.value[at->given[i]] != in[at->moment[i]];
      control(&own, at, frame_s, out.value, in);
      print_frame((double)++made * frame_s, at, &own, in);
      next = out.frame + 1;
    }
    send_inputs(file, layout, ++sequence, next, in);
  }
  fprintf(stderr, "frames %ld, missed %ld\n", made, missed);
  return made == frames && missed == 0 ? 0 : 1;
}

static int with_udp(char** word) {
  Layout layout;
  if (!read_layout(word[1], &layout)) return fail(word[1], "it is not a file of names");
  Places at = {place_of(word[1], "outputs", kCar), {0}, {0}, {0}};
  for (int i = 0; i < kBogies; ++i) {
    at.bogie[i] = place_of(word[1], "outputs", kBogie[i]);
    at.given[i] = place_of(word[1], "outputs", kGiven[i]);
    at.moment[i] = place_of(word[1], "inputs", kMoment[i]);
  }
  if (!is_known(&at)) return fail(word[1], "a name of the controller is not in it");
  const int file = connected(word[0]);
  if (file < 0) return fail(word[0], "no such address; expected HOST:PORT");
  const double frame_s = atof(word[2]), frames = frame_s > 0.0 ? atof(word[3]) / frame_s : 0.0;
  if (!(frames >= 1.0 && frames < 1e9)) return fail(word[3], "expected one frame or more");
  const int code = over_udp(file, &layout, &at, frame_s, (long)(frames + .5));
  close(file);
  return code;
}

int main(int argc, char** argv) {
  if (argc == 3 || argc == 5) printf("time_s,moment_1_n_m,moment_2_n_m,yaw_1_rad,yaw_2_rad\n");
  if (argc == 3) return with_model(argv[1], atof(argv[2]));
  if (argc == 5) return with_udp(argv + 1);
  return fail("usage", "yaw_damper MODEL SECONDS, or yaw_damper HOST:PORT NAMES FRAME_S SECONDS");
}
