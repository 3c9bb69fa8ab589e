#include "page.h"

const uint16_t page_px[SIZES] = {12, 14, 16, 20};

static uint8_t frame[PAGE_WIDTH * PAGE_HEIGHT * 3];

/* All is drawn straight into the frame. */
static void flush(lv_display_t * display, const lv_area_t * area, uint8_t * pixels)
{
    LV_UNUSED(area);
    LV_UNUSED(pixels);
    lv_display_flush_ready(display);
}

void page_begin(void)
{
    lv_display_t * display;

    lv_init();
    display = lv_display_create(PAGE_WIDTH, PAGE_HEIGHT);
    lv_display_set_color_format(display, LV_COLOR_FORMAT_RGB888);
    lv_display_set_flush_cb(display, flush);
    lv_display_set_buffers(display, frame, NULL, sizeof frame, LV_DISPLAY_RENDER_MODE_DIRECT);
}

static lv_obj_t * text(lv_obj_t * parent, const lv_font_t * font, uint32_t color, const char * what)
{
    lv_obj_t * label = lv_label_create(parent);

    lv_label_set_text(label, what);
    lv_obj_set_style_text_font(label, font, 0);
    lv_obj_set_style_text_color(label, lv_color_hex(color), 0);
    return label;
}

/* A card with rows, or a row of a card. */
static lv_obj_t * box(lv_obj_t * parent, bool is_card)
{
    lv_obj_t * obj = lv_obj_create(parent);

    lv_obj_remove_style_all(obj);
    lv_obj_set_size(obj, lv_pct(100), LV_SIZE_CONTENT);
    lv_obj_set_flex_flow(obj, is_card ? LV_FLEX_FLOW_COLUMN : LV_FLEX_FLOW_ROW);
    if(is_card) {
        lv_obj_set_style_bg_color(obj, lv_color_white(), 0);
        lv_obj_set_style_bg_opa(obj, LV_OPA_COVER, 0);
        lv_obj_set_style_radius(obj, 8, 0);
        lv_obj_set_style_pad_hor(obj, 12, 0);
        lv_obj_set_style_pad_ver(obj, 8, 0);
        lv_obj_set_style_pad_row(obj, 7, 0);
    }
    else {
        lv_obj_set_flex_align(obj, LV_FLEX_ALIGN_SPACE_BETWEEN, LV_FLEX_ALIGN_CENTER, LV_FLEX_ALIGN_CENTER);
    }
    return obj;
}

static void setting(lv_obj_t * card, const lv_font_t * const fonts[SIZES], const char * name, const char * value)
{
    lv_obj_t * row = box(card, false);

    text(row, fonts[NORMAL], 0x202124, name);
    text(row, fonts[MEDIUM], 0x5f6368, value);
}

void page_build(const lv_font_t * const fonts[SIZES], const char * subtitle)
{
    lv_obj_t * page = lv_screen_active(), * card, * row, * slider, * toggle;

    lv_obj_clean(page);
    lv_obj_set_style_bg_color(page, lv_color_hex(0xeceff3), 0);
    lv_obj_set_style_pad_all(page, 12, 0);
    lv_obj_set_style_pad_row(page, 8, 0);
    lv_obj_set_flex_flow(page, LV_FLEX_FLOW_COLUMN);
    lv_obj_remove_flag(page, LV_OBJ_FLAG_SCROLLABLE);

    text(page, fonts[LARGE], 0x202124, LV_SYMBOL_SETTINGS "  Settings");
    text(page, fonts[SMALL], 0x5f6368, subtitle);

    text(page, fonts[MEDIUM], 0x1a5fb4, "Climate");
    card = box(page, true);
    setting(card, fonts, "Temperature", "21.5 \u00b0C  " LV_SYMBOL_RIGHT);
    setting(card, fonts, "Humidity", "48 %  " LV_SYMBOL_RIGHT);
    setting(card, fonts, "Schedule", "Mon-Fri, 6:30-22:00  " LV_SYMBOL_RIGHT);
    text(card, fonts[SMALL], 0x5f6368, "Holds \u00b1\u00bd \u00b0C around the value that is set.");

    text(page, fonts[MEDIUM], 0x1a5fb4, "Display");
    card = box(page, true);
    row = box(card, false);
    text(row, fonts[NORMAL], 0x202124, "Brightness");
    slider = lv_slider_create(row);
    lv_obj_set_size(slider, 110, 6);
    lv_obj_set_style_margin_right(slider, 8, 0);
    lv_slider_set_value(slider, 70, LV_ANIM_OFF);
    row = box(card, false);
    text(row, fonts[NORMAL], 0x202124, "Night mode");
    toggle = lv_switch_create(row);
    lv_obj_set_size(toggle, 40, 20);
    lv_obj_add_state(toggle, LV_STATE_CHECKED);

    text(page, fonts[MEDIUM], 0x1a5fb4, "Network");
    card = box(page, true);
    setting(card, fonts, LV_SYMBOL_WIFI "  Caf\u00e9 Zo\u00eb", "192.168.0.17  " LV_SYMBOL_RIGHT);
    setting(card, fonts, "Language", "Fran\u00e7ais (Qu\u00e9bec)  " LV_SYMBOL_RIGHT);
    lv_obj_update_layout(page);
}

const uint8_t * page_draw(void)
{
    lv_obj_invalidate(lv_screen_active());
    lv_refr_now(NULL);
    return frame;
}
