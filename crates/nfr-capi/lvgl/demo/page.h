/* A page of settings in four sizes of a font, on a display without a screen. */
#ifndef PAGE_H
#define PAGE_H

#include "lvgl.h"

#define PAGE_WIDTH 320
#define PAGE_HEIGHT 384

enum { SMALL, MEDIUM, NORMAL, LARGE, SIZES };

/* The fonts' sizes in pixels per em. */
extern const uint16_t page_px[SIZES];

/* Begins with LVGL and the display. */
void page_begin(void);

/* Builds the page, of which `subtitle` is the second line, in the fonts, and lays it out. */
void page_build(const lv_font_t * const fonts[SIZES], const char * subtitle);

/* Draws the whole page. The pixels, PAGE_HEIGHT rows of PAGE_WIDTH pixels of three bytes, blue first, are valid until the next call. */
const uint8_t * page_draw(void);

#endif
