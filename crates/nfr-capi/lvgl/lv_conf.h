/* LVGL 9.5 as `check` and `demo/run` build it: RGB888, no operating system, memory from the C library so that the sanitizers see
 * it. Everything else is as LVGL has it by default. */
#ifndef LV_CONF_H
#define LV_CONF_H

#define LV_COLOR_DEPTH 24
#define LV_USE_STDLIB_MALLOC LV_STDLIB_CLIB
#define LV_USE_STDLIB_STRING LV_STDLIB_CLIB
#define LV_USE_STDLIB_SPRINTF LV_STDLIB_CLIB
#define LV_USE_LOG 1
#define LV_LOG_LEVEL LV_LOG_LEVEL_WARN
#define LV_USE_TINY_TTF 1
#define LV_FONT_FMT_TXT_LARGE 0
/* They have the symbols, for which the page's fonts fall back to them. */
#define LV_FONT_MONTSERRAT_12 1
#define LV_FONT_MONTSERRAT_14 1
#define LV_FONT_MONTSERRAT_16 1
#define LV_FONT_MONTSERRAT_20 1

#endif
