// Which program this is: whether ray pieces let each channel through by itself.
const int kHrcMedia = 0;
