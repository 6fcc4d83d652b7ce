/* SPDX-License-Identifier: MIT
 *
 * stm32f2: the registers of an STM32F2 that the firmware uses. Source: RM0033 (chapter and page
 * names at each block); ARMv7-M Architecture Reference Manual for the core registers.
 */
#pragma once

#include "base.h"

#define REG(address) (*(volatile U32*)(address))

/* Reset and clock control (RM0033, 5.3). */
#define RCC_CR REG(0x40023800UL)
#define RCC_CR_HSEON (1UL << 16)
#define RCC_CR_HSERDY (1UL << 17)
#define RCC_CR_HSEBYP (1UL << 18) /* the HSE input is a clock at OSC_IN, not a crystal */
#define RCC_CR_PLLON (1UL << 24)
#define RCC_CR_PLLRDY (1UL << 25)
/* fields: M 5..0, N 14..6, P 17..16, HSE as source 22, Q 27..24 */
#define RCC_PLLCFGR REG(0x40023804UL)
#define RCC_CFGR REG(0x40023808UL)
#define RCC_CFGR_SW_PLL 2UL
#define RCC_CFGR_SWS_MASK (3UL << 2)
#define RCC_CFGR_SWS_PLL (2UL << 2)
#define RCC_CFGR_APB1_DIV4 (5UL << 10)
#define RCC_CFGR_APB2_DIV2 (4UL << 13)
#define RCC_AHB1ENR REG(0x40023830UL) /* bits: GPIOA 0 to GPIOI 8, CRC 12 */
#define RCC_AHB1ENR_CRC (1UL << 12)
#define RCC_AHB1ENR_BKPSRAM (1UL << 18)
#define RCC_AHB2ENR REG(0x40023834UL)
#define RCC_AHB2ENR_RNG (1UL << 6)
#define RCC_AHB3ENR REG(0x40023838UL)
#define RCC_AHB3ENR_FSMC (1UL << 0)
#define RCC_APB1ENR REG(0x40023840UL)
#define RCC_APB1ENR_PWR (1UL << 28)
#define RCC_APB2ENR REG(0x40023844UL)
#define RCC_APB2ENR_USART1 (1UL << 4)
#define RCC_APB2ENR_SPI1 (1UL << 12)
#define RCC_APB2ENR_SYSCFG (1UL << 14)
#define RCC_CSR REG(0x40023874UL)
#define RCC_CSR_RMVF (1UL << 24) /* writing 1 clears the reset flags below */
#define RCC_CSR_PORRST (1UL << 27)
#define RCC_CSR_IWDGRST (1UL << 29)

/* Flash interface (RM0033, 2.3; PM0059): 3 wait states at 120 MHz and 3.3 V, caches and
 * prefetch. */
#define FLASH_ACR REG(0x40023C00UL)
#define FLASH_ACR_120MHZ (3UL | 7UL << 8)
#define FLASH_KEYR REG(0x40023C04UL)
#define FLASH_KEY1 0x45670123UL
#define FLASH_KEY2 0xCDEF89ABUL
#define FLASH_SR REG(0x40023C0CUL)
#define FLASH_SR_ERRORS 0xF2UL /* OPERR, WRPERR, PGAERR, PGPERR, PGSERR; write 1 to clear */
#define FLASH_SR_BSY (1UL << 16)
#define FLASH_CR REG(0x40023C10UL)
#define FLASH_CR_PG 1UL
#define FLASH_CR_SER 2UL /* sector number in bits 6..3 */
#define FLASH_CR_X32 (2UL << 8)
#define FLASH_CR_STRT (1UL << 16)
#define FLASH_CR_LOCK (1UL << 31)
#define FLASH_OPTKEYR REG(0x40023C08UL)
#define FLASH_OPTKEY1 0x08192A3BUL
#define FLASH_OPTKEY2 0x4C5D6E7FUL
#define FLASH_OPTCR REG(0x40023C14UL)
#define FLASH_OPTCR_LOCK 1UL
#define FLASH_OPTCR_STRT 2UL
#define FLASH_OPTCR_RDP 0xFF00UL /* read protection: 0xAA none, 0xCC permanent, others level 1 */
#define FLASH_OPTCR_RDP_NONE 0xAA00UL
#define FLASH_OPTCR_RDP_1 0x5500UL

/* CRC unit (RM0033, 3.4): polynomial 0x04C11DB7, initial value 0xFFFFFFFF, input in words, most
 * significant bit first. */
#define CRC_DR REG(0x40023000UL)
#define CRC_CR REG(0x40023008UL) /* 1: restart */

/* Random number generator (RM0033, 20.4), clocked by the PLL's 48 MHz output. */
#define RNG_CR REG(0x50060800UL)
#define RNG_CR_RNGEN (1UL << 2)
#define RNG_SR REG(0x50060804UL)
#define RNG_SR_DRDY (1UL << 0)
#define RNG_SR_CEIS (1UL << 5)
#define RNG_SR_SEIS (1UL << 6)
#define RNG_DR REG(0x50060808UL)

/* Power control (RM0033, 4.4), and the 4 KiB of backup SRAM, as words; VBAT supplies this SRAM
 * (4.1.2). */
#define PWR_CR REG(0x40007000UL)
#define PWR_CR_DBP (1UL << 8) /* DBP: write access to the backup domain */
#define PWR_CSR REG(0x40007004UL)
#define PWR_CSR_BRE (1UL << 9) /* BRE: regulator that supplies the backup SRAM without VDD */
#define BKPSRAM(word) REG(0x40024000UL + 4UL * (word))

/* General-purpose pins (RM0033, 6.4). Port number 0 is GPIOA. */
#define GPIO(port, offset) REG(0x40020000UL + 0x400UL * (U32)(port) + (offset))
/* two bits for each pin: 0 input, 2 alternate function */
#define GPIO_MODER(port) GPIO(port, 0x00UL)
#define GPIO_OTYPER(port) GPIO(port, 0x04UL)  /* one bit for each pin: 1 is open drain */
#define GPIO_OSPEEDR(port) GPIO(port, 0x08UL) /* two bits for each pin: 3 is 100 MHz */
#define GPIO_PUPDR(port) GPIO(port, 0x0CUL)   /* two bits for each pin: 1 is pull-up */
#define GPIO_IDR(port) GPIO(port, 0x10UL)
/* one bit for each pin: bits 15..0 set, bits 31..16 reset */
#define GPIO_BSRR(port) GPIO(port, 0x18UL)
#define GPIO_AFR(port, half) GPIO(port, 0x20UL + 4UL * (half)) /* four bits for each pin */
#define GPIO_AF_USART1 7UL
/* The same registers as word indices relative to a port's base address. */
#define GPIO_MODE 0U
#define GPIO_SPEED 2U
#define GPIO_PULL 3U
#define GPIO_AFRL 8U
#define GPIO_AFRH 9U

/* External interrupt lines, and the port of each line (RM0033, 7.2 and 8.3). */
/* four bits for each line: the number of the port */
#define SYSCFG_EXTICR(n) REG(0x40013808UL + 4UL * (n))
#define EXTI_IMR REG(0x40013C00UL)
#define EXTI_RTSR REG(0x40013C08UL)
#define EXTI_FTSR REG(0x40013C0CUL)
#define EXTI_PR REG(0x40013C14UL) /* write 1 to clear */

/* USART 1 (RM0033, 24.6), clocked by PCLK2, 60 MHz. */
#define USART1_SR REG(0x40011000UL)
#define USART1_SR_RXNE (1UL << 5)
#define USART1_SR_TC (1UL << 6)
#define USART1_SR_TXE (1UL << 7)
#define USART1_DR REG(0x40011004UL)
#define USART1_BRR REG(0x40011008UL)
#define USART1_BRR_115200 521UL
#define USART1_CR1 REG(0x4001100CUL)
/* UE, TE, RE: enabled, with transmitter and receiver; 8 data bits */
#define USART1_CR1_ON 0x200CUL

/* SPI 1 (RM0033, 25.5). */
#define SPI1_CR1 REG(0x40013000UL)
#define SPI1_CR1_MASTER 0x0344UL /* enabled, master, PCLK2 / 2, mode 0, no NSS pin */
#define SPI1_CR1_SLAVE 0x0040UL  /* enabled, slave selected by its NSS pin, mode 0 */
#define SPI1_SR REG(0x40013008UL)
#define SPI1_SR_RXNE 1UL
#define SPI1_DR REG(0x4001300CUL)

/* Independent watchdog (RM0033, 18.3), clocked by LSI, about 32 kHz. */
#define IWDG_KR REG(0x40003000UL)
#define IWDG_KR_START 0xCCCCUL
#define IWDG_KR_UNLOCK 0x5555UL
#define IWDG_KR_REFRESH 0xAAAAUL
#define IWDG_PR REG(0x40003004UL) /* prescaler: LSI / (4 << n) */
#define IWDG_RLR REG(0x40003008UL)

/* Core registers (ARMv7-M ARM, B3). */
#define SYST_CSR REG(0xE000E010UL)
#define SYST_CSR_ON 7UL /* enabled, clocked by HCLK, with interrupt */
#define SYST_CSR_POLLED 5UL
#define SYST_RVR REG(0xE000E014UL)
#define SYST_CVR REG(0xE000E018UL)
#define SYST_CALIB REG(0xE000E01CUL) /* ticks of HCLK/8 in one millisecond (RM0033, 8.1.2) */
#define SYST_MS ((SYST_CALIB & 0xFFFFFFUL) * 8UL) /* HCLK cycles per millisecond */
#define NVIC_ISER(n) REG(0xE000E100UL + 4UL * (n))
#define NVIC_ICER(n) REG(0xE000E180UL + 4UL * (n))
#define NVIC_ICPR(n) REG(0xE000E280UL + 4UL * (n))
#define NVIC_IPR(n) (*(volatile U8*)(0xE000E400UL + (n)))
#define SCB_ICSR REG(0xE000ED04UL)
#define SCB_ICSR_PENDSTCLR (1UL << 25)
#define SCB_ICSR_PENDSTSET (1UL << 26)
#define SCB_VTOR REG(0xE000ED08UL)
#define SCB_AIRCR REG(0xE000ED0CUL)
#define SCB_AIRCR_RESET 0x05FA0004UL
/* priority of exception n, 4..15; one byte */
#define SCB_SHPR(n) (*(volatile U8*)(0xE000ED14UL + (n)))
#define SCB_SHCSR REG(0xE000ED24UL)
#define SCB_SHCSR_FAULTS (7UL << 16) /* enables separate usage, bus and memory fault handlers */
#define SCB_CFSR REG(0xE000ED28UL)
#define SCB_CFSR_MMFARVALID (1UL << 7)
#define SCB_CFSR_BFARVALID (1UL << 15)
#define SCB_MMFAR REG(0xE000ED34UL)
#define SCB_BFAR REG(0xE000ED38UL)
#define MPU_CTRL REG(0xE000ED94UL)
/* enabled, with the default memory map as background for privileged code */
#define MPU_CTRL_ON 5UL
#define MPU_RBAR REG(0xE000ED9CUL)
#define MPU_RASR REG(0xE000EDA0UL)
