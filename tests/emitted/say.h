/* Writes a text to the console. */
#ifdef __cplusplus
extern "C" {
#endif
void say(const char* text);
#ifdef __cplusplus
}
#endif
