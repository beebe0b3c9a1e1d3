# SPDX-License-Identifier: BSD-3-Clause
# The style of all pictures. The colours can be distinguished with most kinds of colour blindness (Okabe and Ito 2008).
set encoding utf8
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set grid xtics ytics lc rgb "#d8d8d8" lt 1
set border 3 lc rgb "#404040"
set tics nomirror out
set key top left Left reverse samplen 2 spacing 1.15
blue = "#0072B2"; orange = "#D55E00"; green = "#009E73"; purple = "#CC79A7"; grey = "#707070"
